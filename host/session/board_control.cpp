#include "host/session/board_control.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gyrolog {
namespace {

constexpr std::chrono::milliseconds reply_timeout(1000);
constexpr std::chrono::milliseconds flush_time(
    150);  // for the partial frame that a board sends when it is stopped

// Of an MPU-9250: a board says only that one of its settings is wrong.
constexpr std::uint32_t base_rate_mHz = 1'000'000;
constexpr std::uint32_t divisor_most = 250;
constexpr std::uint32_t fast_rate_mHz = 8'000'000;

template <typename Values, typename Value>
bool has(const Values& values, Value value) {
    return std::ranges::find(values, value) != values.end();
}

bool is_divided(std::uint32_t rate_mHz) {
    return rate_mHz * divisor_most >= base_rate_mHz && base_rate_mHz % rate_mHz == 0;
}

// The first of the settings that such a sensor does not have, with those that it has.
std::string refused_setting(const glp_configure& wanted) {
    const std::uint16_t dps = wanted.gyro_full_scale_dps;
    if (dps != 0 && !has(mpu9250_full_scales_dps, dps)) {
        return fmt::format("--full-scale {}: an MPU-9250 has {} °/s", dps,
                           fmt::join(mpu9250_full_scales_dps, ", "));
    }
    const std::uint16_t dlpf_hz = wanted.dlpf_hz;
    if (dlpf_hz != 0 && dlpf_hz != GLP_DLPF_OFF && !has(mpu9250_dlpfs_hz, dlpf_hz)) {
        return fmt::format("--dlpf {}: an MPU-9250 has {} Hz, and off", dlpf_hz,
                           fmt::join(mpu9250_dlpfs_hz, ", "));
    }
    const double rate_hz = wanted.rate_mHz * 1e-3;
    constexpr const char* rates = "1000 Hz over a whole number up to 250 (500, 200, 100, ... 4 Hz)";
    if (wanted.rate_mHz != 0 && wanted.rate_mHz != fast_rate_mHz && !is_divided(wanted.rate_mHz)) {
        return fmt::format("--rate {:g}: an MPU-9250 has {}, and 8000 Hz", rate_hz, rates);
    }
    return fmt::format(
        "--rate {:g} together with this low-pass: an MPU-9250 has {}, or 8000 Hz with --dlpf 250, "
        "3600 or off",
        rate_hz, rates);
}

}  // namespace

Status BoardControl::quiet(const GoOn& go_on) {
    Status lowered = source_.set_line_state(false);
    if (lowered.ok()) { return {}; }
    if (lowered.error().code != ErrorCode::unsupported) { return lowered; }
    has_line_ = false;
    const Status stopped = command(glp_frame_stop, {}, go_on);
    if (!stopped.ok() && stopped.error().code == ErrorCode::unsupported) {
        takes_commands_ = false;
        return {};
    }
    // A board that was quiet already, or is still booting, may leave this one unanswered.
    return stopped.ok() || stopped.error().code == ErrorCode::timeout ? Status() : stopped;
}

Status BoardControl::configure(const glp_configure& wanted, const GoOn& go_on) {
    const bool asked = wanted.rate_mHz != 0 || wanted.dlpf_hz != 0 || wanted.gyro_full_scale_dps != 0 ||
                       wanted.accel_full_scale_g != 0 || wanted.layout != 0 || wanted.samples_per_frame != 0;
    if (!asked) { return {}; }
    if (!takes_commands_) {
        return Error{
            ErrorCode::invalid_argument,
            source_.identity().uri + " cannot be configured: leave --rate, --full-scale and --dlpf out"};
    }
    wanted_ = wanted;
    std::array<std::uint8_t, GLP_FRAME_PAYLOAD_MAX> payload{};
    const std::size_t size = glp_configure_write(&wanted, payload.data(), payload.size());
    return command(glp_frame_configure, ByteView(payload).first(size), go_on);
}

Status BoardControl::start(const GoOn& go_on) {
    start_asked_ = true;
    streaming_ = true;
    if (has_line_) { return source_.set_line_state(true); }
    if (!takes_commands_) { return {}; }
    GYROLOG_CHECK(command(glp_frame_start, {}, go_on));
    return send(glp_frame_get_hello, {});
}

void BoardControl::stop() {
    if (!start_asked_) { return; }
    if (has_line_) {
        static_cast<void>(source_.set_line_state(false));
    } else if (takes_commands_) {
        static_cast<void>(send(glp_frame_stop, {}));
    }
    if (!source_.can_wait()) { std::this_thread::sleep_for(flush_time); }
}

Status BoardControl::set_streaming(bool wanted, const GoOn& go_on) {
    if (wanted == streaming_ || !(has_line_ || takes_commands_)) { return {}; }
    streaming_ = wanted;
    if (wanted) { return start(go_on); }
    stop();
    return {};
}

Status BoardControl::send(glp_frame_type type, ByteView payload) {
    const glp_frame frame{static_cast<std::uint8_t>(type), 0, ++sequence_, payload.data(), payload.size()};
    std::array<std::uint8_t, GLP_FRAME_WIRE_MAX> wire{};
    const glp_cobs_result encoded = glp_frame_encode(&frame, wire.data(), wire.size());
    writer_.expect_reply(sequence_, frame.type);
    return source_.write(ByteView(wire).first(encoded.size));
}

Status BoardControl::command(glp_frame_type type, ByteView payload, const GoOn& go_on) {
    GYROLOG_CHECK(send(type, payload));
    std::optional<std::uint8_t> result;
    writer_.wait(reply_timeout, go_on, [&](const WriterThread::State& state) {
        if (state.reply) { result = state.reply->result; }
        return result.has_value() || sink_.end().has_value();
    });
    if (!result) {
        if (const auto error = sink_.error()) { return *error; }
        return Error{ErrorCode::timeout,
                     "the board on " + source_.identity().uri + " did not answer a command"};
    }
    return refusal(*result);
}

Status BoardControl::refusal(std::uint8_t result) const {
    switch (result) {
        case glp_result_ok:
            return {};
        case glp_result_bad_value:
            return Error{ErrorCode::invalid_argument, "the board on " + source_.identity().uri +
                                                          " does not have " + refused_setting(wanted_)};
        case glp_result_sensor_fault:
            return Error{ErrorCode::failed,
                         "the board on " + source_.identity().uri + " cannot talk to its sensor"};
        default:
            return Error{ErrorCode::unsupported, fmt::format("the board on {} refused a command (result {})",
                                                             source_.identity().uri, result)};
    }
}

}  // namespace gyrolog
