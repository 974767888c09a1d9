#include "tests/native_firmware/usb_rig.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include <gyrolog_protocol/usb_identity.h>

namespace gyrolog {
namespace {

constexpr double step_s = 0.5e-3;
constexpr double patience_s = 1.0;
constexpr std::size_t posted_transfers = 4;
constexpr std::size_t posted_bytes = 4096;
constexpr std::uint8_t new_address = 5;
enum Request : std::uint8_t { set_address = 5, get_descriptor = 6, set_configuration = 9 };
enum Descriptor : std::uint8_t { device_kind = 1, configuration_kind = 2, string_kind = 3 };

}  // namespace

glp_frame ArrivedFrame::as_frame() const {
    glp_frame frame{};
    frame.type = type;
    frame.flags = flags;
    frame.sequence = sequence;
    frame.payload = payload.data();
    frame.payload_bytes = payload.size();
    return frame;
}

UsbRig::UsbRig(const NativeBoardOptions& options)
    : board_(options), host_(board_.processor(), board_.usb(), notification_in) {
    board_.processor().add_surroundings(host_);
    glp_stream_init(&stream_);
}

void UsbRig::run_s(double duration_s) {
    Processor& processor = board_.processor();
    const auto ticks = [](double time_s) {
        return static_cast<std::uint64_t>(time_s * 1e6 * static_cast<double>(part_ticks_per_us));
    };
    const std::uint64_t end = processor.now_ticks() + ticks(duration_s);
    while (processor.now_ticks() < end) {
        post();
        processor.run_until(std::min(end, processor.now_ticks() + ticks(step_s)));
        collect();
    }
}

// ---------------------------------------------------------------------------- transfers

UsbTransferEnd UsbRig::transfer(UsbTransfer transfer) {
    const std::uint32_t id = next_id_++;
    transfer.id = id;
    host_.submit(std::move(transfer));
    for (double waited_s = 0; waited_s < patience_s; waited_s += step_s) {
        run_s(step_s);
        const auto found = std::find_if(others_.begin(), others_.end(),
                                        [id](const UsbTransferEnd& one) { return one.id == id; });
        if (found == others_.end()) { continue; }
        UsbTransferEnd end = std::move(*found);
        others_.erase(found);
        return end;
    }
    host_.give_up(id);
    return {id, -ETIMEDOUT, {}, 0};
}

UsbTransferEnd UsbRig::control(const UsbSetup& setup, Bytes out_data) {
    UsbTransfer request;
    request.setup = setup;
    request.out_data = std::move(out_data);
    if ((setup[0] & 0x80U) != 0) { request.in_bytes = setup[6] | static_cast<std::size_t>(setup[7]) << 8U; }
    return transfer(std::move(request));
}

Bytes UsbRig::descriptor(std::uint8_t kind, std::uint8_t index) {
    const std::uint8_t language = kind == string_kind && index > 0 ? 0x09 : 0;
    return control({0x80, get_descriptor, index, kind, language, language, 0xFF, 0}).in_data;
}

std::string UsbRig::text(std::uint8_t index) {
    const Bytes answer = descriptor(string_kind, index);
    std::string text;
    for (std::size_t i = 2; i + 1 < answer.size(); i += 2) { text += static_cast<char>(answer[i]); }
    return text;
}

// ---------------------------------------------------------------------------- the board's life on the bus

bool UsbRig::enumerate() {
    host_.plug(true);
    constexpr double power_on_s = 0.5;
    for (double waited_s = 0; !board_.usb().attached() && waited_s < power_on_s; waited_s += step_s) {
        run_s(step_s);
    }
    return board_.usb().attached() && enumerate_again();
}

bool UsbRig::enumerate_again() {
    host_.reset();
    constexpr double reset_and_recovery_s = 0.02;  // USB 2.0, 7.1.7.3: 10 ms after the reset
    run_s(reset_and_recovery_s);
    return descriptor(device_kind).size() == 18 &&
           control({0, set_address, new_address, 0, 0, 0, 0, 0}).status == 0 &&
           control({0, set_configuration, 1, 0, 0, 0, 0, 0}).status == 0;
}

bool UsbRig::set_dtr(bool on) {
    return control(
               {0x21, GLP_CDC_SET_CONTROL_LINE_STATE, static_cast<std::uint8_t>(on ? 1 : 0), 0, 0, 0, 0, 0})
               .status == 0;
}

void UsbRig::command(std::uint8_t type, ByteView payload) {
    glp_frame frame{};
    frame.type = type;
    frame.sequence = command_sequence_++;
    frame.payload = payload.data();
    frame.payload_bytes = payload.size();
    std::array<std::uint8_t, GLP_FRAME_WIRE_MAX> wire{};
    const glp_cobs_result encoded = glp_frame_encode(&frame, wire.data(), wire.size());
    UsbTransfer out;
    out.endpoint = data_out;
    out.out_data.assign(wire.begin(), wire.begin() + static_cast<std::ptrdiff_t>(encoded.size));
    transfer(std::move(out));
}

void UsbRig::configure(std::uint32_t rate_hz, std::uint8_t layout) {
    constexpr std::uint32_t rate_of_wide_filter_hz = 8000;
    glp_configure configure{};
    configure.rate_mHz = rate_hz * 1000;
    configure.dlpf_hz = rate_hz == rate_of_wide_filter_hz ? 250 : 184;
    configure.layout = layout;
    std::array<std::uint8_t, 32> payload{};
    command(glp_frame_configure,
            ByteView(payload).first(glp_configure_write(&configure, payload.data(), payload.size())));
}

// ---------------------------------------------------------------------------- the stream

void UsbRig::read(bool on) {
    reading_ = on;
    if (on) { return; }
    for (const std::uint32_t id : posted_) { host_.give_up(id); }
    collect();
    posted_.clear();
}

void UsbRig::post() {
    while (reading_ && posted_.size() < posted_transfers) {
        UsbTransfer in;
        in.id = next_id_++;
        in.endpoint = data_in;
        in.in_bytes = posted_bytes;
        posted_.push_back(in.id);
        host_.submit(std::move(in));
    }
}

void UsbRig::collect() {
    for (UsbTransferEnd& end : host_.take_ended()) {
        const auto found = std::find(posted_.begin(), posted_.end(), end.id);
        if (found == posted_.end()) {
            others_.push_back(std::move(end));
            continue;
        }
        posted_.erase(found);
        for (std::size_t at = 0; at < end.in_data.size();) {
            glp_frame frame{};
            bool have_frame = false;
            at += glp_stream_push(&stream_, end.in_data.data() + at, end.in_data.size() - at, &frame,
                                  &have_frame);
            if (!have_frame) { continue; }
            frames_.push_back({frame.type, frame.flags, frame.sequence,
                               Bytes(frame.payload, frame.payload + frame.payload_bytes)});
        }
    }
}

std::vector<ArrivedFrame> UsbRig::take_frames() { return std::exchange(frames_, {}); }

}  // namespace gyrolog
