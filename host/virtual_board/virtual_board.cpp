#include "host/virtual_board/virtual_board.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <gyrolog_protocol/usb_identity.h>

#include "analysis/simulate/sensor_simulator.hpp"

namespace gyrolog {

namespace {

constexpr std::int64_t poll_period_ns = 10'000'000;  // the main loop's longest pause while it streams
constexpr std::size_t endpoint_bytes = 65536;        // until a host says how much it has posted
constexpr double tick_clock_sd = 20e-6;              // a plain crystal
// A stream that no stage of the simulator uses.
constexpr std::uint32_t clock_stream = 0x434B0000;

VirtualBoard& board_of(void* context) { return *static_cast<VirtualBoard*>(context); }

double relative_sd_of_rate(const SensorModel& model) {
    const auto found = model.sd_abs.find("rate_rel");
    return found == model.sd_abs.end() ? 0.0 : found->second;
}

std::int64_t to_ns(double duration_s) { return std::llround(duration_s * 1e9); }

std::int64_t end_of(const BoardFault& fault, std::int64_t now_ns) {
    return fault.duration_s > 0.0 ? now_ns + to_ns(fault.duration_s) : SimulatedMpu9250::never_ns;
}

}  // namespace

Result<std::unique_ptr<VirtualBoard>> VirtualBoard::create(VirtualBoardOptions options) {
    if (auto refusal = simulation_refusal(options.model)) {
        return Error{ErrorCode::invalid_argument, "simulate the model: " + *refusal};
    }
    std::unique_ptr<VirtualBoard> board(new VirtualBoard(std::move(options)));
    GYROLOG_CHECK(board->power_on());
    board->board_.sequence = board->options_.first_sequence;
    return board;
}

VirtualBoard::VirtualBoard(VirtualBoardOptions options)
    : options_(std::move(options)),
      ticks_per_ns_(options_.tick_hz * 1e-9 *
                    (1.0 + options_.tick_clock_error.value_or(
                               tick_clock_sd * RandomStream(options_.seed, clock_stream).normal(0)))),
      sensor_(options_.model, options_.seed,
              options_.sensor_clock_error.value_or(relative_sd_of_rate(options_.model) *
                                                   RandomStream(options_.seed, clock_stream).normal(1)),
              options_.who_am_i),
      in_endpoint_(endpoint_bytes),
      hal_(make_hal(this)),
      ring_(options_.ring_bytes),
      boot_id_(options_.boot_id),
      due_(options_.faults) {
    std::stable_sort(due_.begin(), due_.end(),
                     [](const BoardFault& a, const BoardFault& b) { return a.at_s > b.at_s; });
}

glp_hal VirtualBoard::make_hal(VirtualBoard* self) {
    glp_hal hal{};
    hal.context = self;
    hal.sensor_on_spi = true;
    hal.ticks = [](void* context) { return board_of(context).ticks(); };
    hal.sensor_write = [](void* context, std::uint8_t address, std::uint8_t value) {
        VirtualBoard& board = board_of(context);
        if (board.bus_errors_due_ > 0) {
            --board.bus_errors_due_;
            return false;
        }
        board.sensor_.write(address, value, board.now_ns_);
        return true;
    };
    hal.sensor_read = [](void* context, std::uint8_t address, std::uint8_t* bytes, std::size_t size) {
        VirtualBoard& board = board_of(context);
        if (board.bus_errors_due_ > 0) {
            --board.bus_errors_due_;
            return false;
        }
        board.sensor_.read(address, {bytes, size});
        return true;
    };
    hal.delay_ms = [](void* context, std::uint32_t duration_ms) {
        board_of(context).now_ns_ += std::int64_t{duration_ms} * 1'000'000;
    };
    hal.link_write = [](void* context, const std::uint8_t* bytes, std::size_t size) {
        return board_of(context).link_write({bytes, size});
    };
    hal.link_flush = [](void* context) { board_of(context).in_endpoint_.flush(); };
    hal.usb_frame_number = [](void* context) {
        return static_cast<std::uint32_t>(board_of(context).now_ns_ / 1'000'000);
    };
    return hal;
}

std::uint64_t VirtualBoard::ticks() const {
    return options_.first_tick + static_cast<std::uint64_t>(static_cast<double>(now_ns_) * ticks_per_ns_);
}

Status VirtualBoard::power_on() {
    static constexpr char firmware_name[] = "gyrolog virtual board";
    glp_board_identity identity{};
    std::copy_n(options_.serial.begin(), std::min<std::size_t>(options_.serial.size(), GLP_UID_BYTES),
                identity.uid);
    identity.firmware = firmware_name;
    identity.tick_hz = options_.tick_hz;
    identity.tick_bits = options_.tick_bits;
    identity.boot_id = boot_id_;
    identity.reset_cause = boot_id_ == options_.boot_id ? glp_reset_power_on : glp_reset_watchdog;
    if (!glp_board_init(&board_, &hal_, &identity, ring_.data(), ring_.size())) {
        return Error{ErrorCode::invalid_argument, "virtual board: its ring or tick counter is too small"};
    }
    if (!glp_board_boot(&board_)) {
        return Error{ErrorCode::failed, "virtual board: the sensor did not start"};
    }
    return configure_at_power_on();
}

// The board is told its start configuration the way a host would tell it, and its answers are not for the
// host.
Status VirtualBoard::configure_at_power_on() {
    glp_configure configure{};
    configure.rate_mHz = static_cast<std::uint32_t>(std::llround(options_.rate_hz * 1000.0));
    configure.gyro_full_scale_dps = static_cast<std::uint16_t>(options_.full_scale_dps);
    configure.dlpf_hz = static_cast<std::uint16_t>(options_.dlpf_hz);
    std::array<std::uint8_t, 32> payload{};
    glp_frame command{};
    command.type = glp_frame_configure;
    command.payload = payload.data();
    command.payload_bytes = glp_configure_write(&configure, payload.data(), payload.size());
    std::array<std::uint8_t, GLP_FRAME_WIRE_MAX> wire{};
    const glp_cobs_result encoded = glp_frame_encode(&command, wire.data(), wire.size());
    glp_board_on_receive(&board_, wire.data(), encoded.size);
    run_main_loop();

    glp_stream stream;
    glp_stream_init(&stream);
    bool accepted = false;
    std::array<std::uint8_t, 512> bytes{};
    std::size_t size = in_endpoint_.take_bytes(bytes);
    for (std::size_t i = 0; i < size;) {
        glp_frame frame{};
        bool have_frame = false;
        i += glp_stream_push(&stream, bytes.data() + i, size - i, &frame, &have_frame);
        glp_reply reply{};
        if (have_frame && frame.type == glp_frame_reply && glp_reply_read(&frame, &reply) == glp_status_ok) {
            accepted = reply.result == glp_result_ok;
        }
    }
    in_endpoint_.clear();
    sensor_.set_pin_divider(board_.plan.decimation, now_ns_);
    if (!accepted) {
        return Error{ErrorCode::invalid_argument,
                     "virtual board: an MPU-9250 has no such combination of rate, full scale and filter"};
    }
    return {};
}

void VirtualBoard::run_main_loop() {
    last_poll_ns_ = now_ns_;
    if (now_ns_ < main_loop_stalled_until_ns_) { return; }
    glp_board_poll(&board_);
}

void VirtualBoard::on_line_state(bool data_terminal_ready) {
    line_state_ = data_terminal_ready;
    glp_board_on_line_state(&board_, data_terminal_ready);
    note_start();
    run_main_loop();
}

void VirtualBoard::on_receive(ByteView bytes) {
    glp_board_on_receive(&board_, bytes.data(), bytes.size());
    sensor_.set_pin_divider(board_.plan.decimation, now_ns_);
    note_start();
    run_main_loop();
}

void VirtualBoard::note_start() {
    if (!board_.streaming || first_start_ns_) { return; }
    first_start_ns_ = now_ns_;
    limit_from_ns_ = now_ns_;
    if (duration_limit_s_) {
        const auto samples =
            static_cast<std::uint64_t>(std::llround(*duration_limit_s_ * sensor_.nominal_rate_hz()));
        sample_limit_ = std::min(sample_limit_.value_or(samples), samples);
    }
}

bool VirtualBoard::sample_limit_reached() const {
    return sample_limit_ && sampling_instants() >= *sample_limit_;
}

bool VirtualBoard::finish() {
    if (line_state_) { on_line_state(false); }
    run_main_loop();
    return unplugged_ || board_.ring.used == 0;
}

std::int64_t VirtualBoard::next_event_ns() const {
    std::int64_t next_ns = SimulatedMpu9250::never_ns;
    if (!sample_limit_reached()) { next_ns = sensor_.next_instant_ns(); }
    if (board_.streaming) { next_ns = std::min(next_ns, last_poll_ns_ + poll_period_ns); }
    if (!due_.empty() && first_start_ns_) {
        next_ns = std::min(next_ns, *first_start_ns_ + to_ns(due_.back().at_s));
    }
    return next_ns;
}

void VirtualBoard::advance_to(std::int64_t time_ns) {
    while (!unplugged_) {
        const std::int64_t next_ns = next_event_ns();
        if (next_ns > time_ns) { break; }
        now_ns_ = std::max(now_ns_, next_ns);
        meet_faults();
        if (sensor_.next_instant_ns() <= now_ns_ && !sample_limit_reached()) { take_instant(); }
        run_main_loop();
    }
    if (unplugged_) { return; }
    now_ns_ = std::max(now_ns_, time_ns);
    run_main_loop();
}

void VirtualBoard::take_instant() {
    const bool frozen = now_ns_ < sensor_frozen_until_ns_;
    const bool pulses = sensor_.pass_instant(frozen);
    if (pulses && now_ns_ >= interrupt_lost_until_ns_) { glp_board_on_sampling_instant(&board_, ticks()); }
}

void VirtualBoard::meet_faults() {
    while (!due_.empty() && first_start_ns_ && *first_start_ns_ + to_ns(due_.back().at_s) <= now_ns_) {
        const BoardFault next = due_.back();
        due_.pop_back();
        fault(next);
    }
}

void VirtualBoard::fault(const BoardFault& fault) {
    switch (fault.kind) {
        case BoardFault::Kind::fifo_overflow: {
            const double samples =
                board_.plan.fifo ? 1.2 * GLP_MPU_FIFO_BYTES / board_.plan.sample_bytes : 3.0;
            main_loop_stalled_until_ns_ =
                now_ns_ + to_ns((samples + board_.config.samples_per_frame) / sensor_.true_rate_hz());
            break;
        }
        case BoardFault::Kind::bus_error:
            ++bus_errors_due_;
            break;
        case BoardFault::Kind::link_stall:
            link_stalled_until_ns_ = now_ns_ + to_ns(fault.duration_s);
            break;
        case BoardFault::Kind::drop_packet:
            drop_bytes_due_ = GLP_USB_PACKET_BYTES;
            break;
        case BoardFault::Kind::duplicate_packet:
            duplicate_due_ = true;
            break;
        case BoardFault::Kind::corrupt_byte:
            corrupt_due_ = true;
            break;
        case BoardFault::Kind::reset:
            begin_anew();
            if (line_state_) { on_line_state(true); }
            break;
        case BoardFault::Kind::unplug:
            unplugged_ = true;
            on_line_state(false);
            replug_ns_.reset();
            if (fault.duration_s > 0.0) { replug_ns_ = now_ns_ + to_ns(fault.duration_s); }
            break;
        case BoardFault::Kind::int_lost:
            interrupt_lost_until_ns_ = end_of(fault, now_ns_);
            break;
        case BoardFault::Kind::sensor_reset:
            sensor_.reset(now_ns_);
            break;
        case BoardFault::Kind::sensor_frozen:
            sensor_frozen_until_ns_ = end_of(fault, now_ns_);
            break;
    }
}

// Of what is left of the run, the time that has passed.
void VirtualBoard::spend_limit() {
    if (!sample_limit_ || !first_start_ns_) { return; }
    const double passed = static_cast<double>(now_ns_ - limit_from_ns_) * 1e-9 * sensor_.nominal_rate_hz();
    *sample_limit_ -= std::min(*sample_limit_ - 1, static_cast<std::uint64_t>(std::llround(passed)));
    limit_from_ns_ = now_ns_;
}

void VirtualBoard::begin_anew() {
    spend_limit();
    ++boot_id_;
    // The sensor and its configuration were good at power-on, so this cannot fail.
    static_cast<void>(power_on());
}

void VirtualBoard::replug(std::int64_t time_ns) {
    unplugged_ = false;
    replug_ns_.reset();
    in_endpoint_.clear();
    if (options_.self_powered) {
        advance_to(time_ns);
        in_endpoint_.clear();
        spend_limit();
        return;
    }
    now_ns_ = std::max(now_ns_, time_ns);
    begin_anew();
}

std::size_t VirtualBoard::link_write(ByteView bytes) {
    if (unplugged_) { return 0; }
    last_write_ns_ = now_ns_;
    if (now_ns_ < link_stalled_until_ns_) { return 0; }
    if (drop_bytes_due_ > 0) {
        const std::size_t dropped = std::min(drop_bytes_due_, bytes.size());
        drop_bytes_due_ -= dropped;
        return dropped;
    }
    if (corrupt_due_ && !bytes.empty()) {
        const Bytes flipped = {static_cast<std::uint8_t>(bytes[bytes.size() / 2] ^ 0x10U)};
        const ByteView head = bytes.first(bytes.size() / 2);
        const std::size_t accepted = in_endpoint_.write(head);
        if (accepted < head.size() || in_endpoint_.write(flipped) == 0) { return accepted; }
        corrupt_due_ = false;
        return accepted + 1;
    }
    if (duplicate_due_) {
        duplicate_due_ = false;
        in_endpoint_.write(bytes.first(std::min<std::size_t>(bytes.size(), GLP_USB_PACKET_BYTES)));
    }
    return in_endpoint_.write(bytes);
}

}  // namespace gyrolog
