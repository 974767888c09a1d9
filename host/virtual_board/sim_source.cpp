#include "host/virtual_board/sim_source.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <limits>

#include <gyrolog_protocol/usb_identity.h>

#include "host/transport/stream_size.hpp"
#include "host/virtual_board/usb_descriptors.hpp"

namespace gyrolog {

namespace {

constexpr std::size_t transfer_bytes = 16384;
constexpr std::size_t queued_bytes_max = std::size_t{4} << 20U;  // as on USB
constexpr std::int64_t step_ns = 20'000'000;  // simulated time between two looks at what has come
constexpr std::int64_t delivery_period_ns = 1'000'000'000;  // a transfer is not kept open for longer
constexpr std::int64_t tick_ns = 1'000'000;      // real time between two turns of the real-time board
constexpr std::int64_t retry_ns = 500'000;       // until a sink without room is asked again
constexpr double nominal_rate_tolerance = 0.01;  // of the model's rate about one that the sensor has

// A rate that the sensor has, near the model's: 1 kHz / n, or above 1 kHz 8 kHz / n.
std::optional<double> nominal_rate_near(double rate_hz) {
    if (!(rate_hz > 0.0)) { return std::nullopt; }
    const double inside_hz = rate_hz > 1000.0 * (1.0 + nominal_rate_tolerance) ? 8000.0 : 1000.0;
    const double divider = std::max(1.0, std::floor(inside_hz / rate_hz + 0.5));
    const double nominal_hz = inside_hz / divider;
    if (divider > 256.0 || std::fabs(rate_hz / nominal_hz - 1.0) > nominal_rate_tolerance) {
        return std::nullopt;
    }
    return nominal_hz;
}

// The narrowest filter setting that has the rate and leaves the output as it is; 0 is the firmware's own,
// 41 Hz. Of the settings that keep the FIFO in use there is none for more than 460 Hz: `fifo` then takes the
// widest of them.
unsigned dlpf_for(double rate_hz, bool fifo) {
    if (SimulatedMpu9250::widest_filter * rate_hz <= 41.0) { return 0; }
    if (SimulatedMpu9250::widest_filter * rate_hz <= 184.0 || (fifo && rate_hz <= 1000.0)) { return 184; }
    return rate_hz <= 8000.0 ? 3600 : GLP_DLPF_OFF;
}

unsigned full_scale_for(const SensorModel& model) {
    for (const unsigned range_dps : {250U, 500U, 1000U}) {
        if (model.full_scale_rad_s <= range_dps * rad_per_deg * 1.001) { return range_dps; }
    }
    return 2000;
}

std::string serial_of(unsigned board) {
    const std::string number = std::to_string(board);
    return "SIM" + std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number;
}

std::string uri_of(const SimOptions& options) {
    std::string uri = "sim:" + options.text;
    if (options.boards > 1) {
        uri += (options.text.empty() ? "board=" : ",board=") + std::to_string(options.board);
    }
    return uri;
}

}  // namespace

Result<std::unique_ptr<SimSource>> SimSource::create(const SimOptions& options, const SensorModel& model,
                                                     const SimLimit& limit) {
    VirtualBoardOptions board_options;
    board_options.model = model;
    // The boards of one seed are as different as those of different seeds: an odd multiplier meets no other
    // soon.
    board_options.seed = options.seed + (options.board - 1) * 0x9E3779B97F4A7C15U;
    board_options.serial = serial_of(options.board);
    board_options.sensor_clock_error = options.clock_error;
    if (!options.model_path.empty()) {
        // A model says all that is wrong with its clock: the capture is to be the signal that it simulates.
        board_options.sensor_clock_error = options.clock_error.value_or(0.0);
        board_options.tick_clock_error = 0.0;
    }
    if (options.rate_hz) {
        board_options.rate_hz = *options.rate_hz;
    } else if (const auto nominal_hz = nominal_rate_near(model.rate_hz)) {
        board_options.rate_hz = *nominal_hz;
        if (!options.clock_error && model.rate_hz != *nominal_hz) {
            board_options.sensor_clock_error = model.rate_hz / *nominal_hz - 1.0;
        }
    } else {
        return Error{ErrorCode::invalid_argument, "simulated board: the model's rate_hz " +
                                                      std::to_string(model.rate_hz) +
                                                      " is no rate of an MPU-9250; add rate=HZ"};
    }
    // What captures a given model is to be the signal that it simulates.
    board_options.dlpf_hz =
        options.dlpf_hz.value_or(dlpf_for(board_options.rate_hz, options.model_path.empty()));
    board_options.full_scale_dps = options.full_scale_dps.value_or(full_scale_for(model));
    board_options.first_tick = options.first_tick;
    board_options.first_sequence = options.first_sequence;
    board_options.boot_id = options.boot_id;
    board_options.ring_bytes = options.ring_bytes;
    board_options.faults = options.faults;
    board_options.self_powered = options.self_powered;
    board_options.endpoints = options.endpoints;
    board_options.who_am_i = options.who_am_i;
    GYROLOG_TRY(std::unique_ptr<VirtualBoard> board, VirtualBoard::create(std::move(board_options)));
    return std::unique_ptr<SimSource>(new SimSource(options, limit, std::move(board)));
}

SimSource::SimSource(const SimOptions& options, const SimLimit& limit, std::unique_ptr<VirtualBoard> board)
    : realtime_(options.realtime),
      board_(std::move(board)),
      ring_bytes_(board_->firmware().ring.capacity),
      buffer_(transfer_bytes),
      queued_bytes_(transfer_bytes) {
    identity_.uri = uri_of(options);
    identity_.vendor_id = GLP_USB_VENDOR_ID;
    identity_.product_id = GLP_USB_PRODUCT_ID;
    identity_.bus_number = 1;
    identity_.device_address = static_cast<std::uint8_t>(options.board + 1);  // 1 is the root hub
    identity_.manufacturer = virtual_board_manufacturer;
    identity_.product = virtual_board_product;
    identity_.serial = board_->serial();
    identity_.device_descriptor = device_descriptor();
    identity_.configuration_descriptor = configuration_descriptor(board_->endpoints());
    board_->set_sample_limit(limit.samples);
    board_->set_duration_limit(limit.duration_s);
    // Real time: one transfer posted, beside the endpoint's own two packets. Otherwise there is always room.
    board_->in_endpoint().set_capacity(
        transfer_bytes + (realtime_ ? std::size_t{2} * GLP_USB_PACKET_BYTES : 3 * transfer_bytes));
}

SimSource::~SimSource() { stop(); }

double SimSource::stream_bytes_per_sample() const {
    const glp_config& config = board_->firmware().config;
    return wire_bytes(config) / config.samples_per_frame;
}

double SimSource::tolerated_stall_s(double bytes_per_s, double /*bytes_per_frame*/) const {
    if (!realtime_) { return std::numeric_limits<double>::infinity(); }
    return static_cast<double>(queued_bytes_ + ring_bytes_) / bytes_per_s;
}

void SimSource::expect(double bytes_per_s, double bytes_per_frame) {
    if (!realtime_ || tolerated_stall_s(bytes_per_s, bytes_per_frame) >= stall_to_ride_out_s) { return; }
    queued_bytes_ = std::min(queued_bytes_max, static_cast<std::size_t>(stall_to_ride_out_s * bytes_per_s));
    static_cast<void>(enqueue({std::nullopt, {}, queued_bytes_}));
}

// ------------------------------------------------------------------------------------------- the caller's
// side

Status SimSource::start(TransferSink& sink) {
    if (thread_.joinable()) {
        return Error{ErrorCode::invalid_argument, identity_.uri + ": already started"};
    }
    sink_ = &sink;
    if (!started_before_) {
        origin_ = host_now();
        origin_board_ns_ = board_->now_ns();
    }
    started_before_ = true;
    last_event_ = host_time();
    thread_ = std::thread([this] { run(); });
    return {};
}

Status SimSource::set_line_state(bool data_terminal_ready) { return enqueue({data_terminal_ready, {}, 0}); }

Status SimSource::write(ByteView bytes) {
    return enqueue({std::nullopt, Bytes(bytes.begin(), bytes.end()), 0});
}

Status SimSource::enqueue(Call call) {
    const std::lock_guard lock(mutex_);
    if (ended_) { return Error{ErrorCode::device_lost, identity_.uri + ": the board is gone"}; }
    calls_.push_back(std::move(call));
    called_.notify_one();
    return {};
}

void SimSource::stop() {
    {
        const std::lock_guard lock(mutex_);
        stop_wanted_ = true;
        called_.notify_one();
    }
    if (thread_.joinable()) { thread_.join(); }
}

// Without real time the pause is over at once, and only the board's time knows of it.
Status SimSource::reconnect() {
    const auto back_ns = board_->replug_ns();
    if (!board_->unplugged() || !back_ns) {
        return Error{ErrorCode::unsupported, identity_.uri + ": unplugged for good"};
    }
    const std::int64_t now_ns = realtime_ ? board_ns_of_now() : *back_ns;
    if (now_ns < *back_ns) { return Error{ErrorCode::not_found, identity_.uri + ": unplugged"}; }
    board_->replug(now_ns);
    calls_.clear();
    end_.reset();
    ended_ = false;
    stop_wanted_ = false;
    return {};
}

// ------------------------------------------------------------------------------------------ the source's
// thread

void SimSource::run() {
    if (realtime_) {
        run_in_real_time();
    } else {
        run_as_fast_as_taken();
    }
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    std::optional<Error> error;
    if (end_ == SourceEnd::device_lost) {
        error = Error{ErrorCode::device_lost, identity_.uri + ": unplugged"};
    }
    sink_->on_end(end_.value_or(SourceEnd::stopped), error);
}

void SimSource::run_as_fast_as_taken() {
    std::int64_t delivered_ns = board_->now_ns();
    while (!end_) {
        if (!answer_calls()) { return; }
        if (!board_->streaming()) {
            // A board at rest has nothing to say until it is asked.
            if (!wait_for_call(delivery_period_ns)) { return; }
            continue;
        }
        board_->advance_to(board_->now_ns() + step_ns);
        if (board_->unplugged()) {
            deliver_bytes(1);
            deliver_in({}, -ESHUTDOWN);
            end_ = SourceEnd::device_lost;
        } else if (board_->sample_limit_reached()) {
            if (!finish_stream()) { return; }
            end_ = SourceEnd::exhausted;
        } else {
            const bool due = board_->now_ns() - delivered_ns >= delivery_period_ns;
            if (due) { delivered_ns = board_->now_ns(); }
            if (!deliver_bytes(due ? 1 : transfer_bytes)) { return; }
        }
    }
}

void SimSource::run_in_real_time() {
    while (!end_) {
        if (!answer_calls()) { return; }
        const std::int64_t now_ns = board_ns_of_now();
        board_->advance_to(now_ns);
        if (board_->unplugged()) {
            deliver_packets();
            deliver_in({}, -ESHUTDOWN);
            end_ = SourceEnd::device_lost;
        } else if (board_->streaming() && board_->sample_limit_reached()) {
            if (!finish_stream()) { return; }
            end_ = SourceEnd::exhausted;
        } else if (!deliver_packets() || !wait_for_call(tick_ns)) {
            return;
        }
    }
}

// The answers to what the host has asked so far are delivered before anything else happens. False: stop.
bool SimSource::answer_calls() {
    while (true) {
        Call call;
        {
            const std::lock_guard lock(mutex_);
            if (calls_.empty()) { return !stop_wanted_; }
            call = std::move(calls_.front());
            calls_.pop_front();
        }
        make(call);
        if (!(realtime_ ? deliver_packets() : deliver_bytes(1))) { return false; }
    }
}

void SimSource::make(const Call& call) {
    if (call.queued_bytes > 0) {
        board_->in_endpoint().set_capacity(call.queued_bytes + std::size_t{2} * GLP_USB_PACKET_BYTES);
        return;
    }
    if (call.line_state) {
        // SET_CONTROL_LINE_STATE, to the control interface (PSTN 1.2, 6.3.12)
        const unsigned lines = *call.line_state ? GLP_CDC_LINE_DTR | GLP_CDC_LINE_RTS : 0U;
        deliver_pair(TransferKind::control, 0,
                     {0x21, GLP_CDC_SET_CONTROL_LINE_STATE, static_cast<std::uint8_t>(lines), 0,
                      GLP_USB_INTERFACE_CONTROL, 0, 0, 0},
                     {});
        board_->on_line_state(*call.line_state);
        return;
    }
    deliver_pair(TransferKind::bulk, board_->endpoints().out, {}, call.bytes);
    board_->on_receive(call.bytes);
}

// False: stop.
bool SimSource::wait_for_call(std::int64_t time_ns) {
    std::unique_lock lock(mutex_);
    called_.wait_for(lock, std::chrono::nanoseconds(time_ns),
                     [&] { return stop_wanted_ || !calls_.empty(); });
    return !stop_wanted_ || !calls_.empty();
}

// Stops the board and delivers all that it still has. False: stop.
bool SimSource::finish_stream() {
    bool empty = false;
    while (!empty) {
        empty = board_->finish();
        if (!(realtime_ ? deliver_packets() : deliver_bytes(1))) { return false; }
        if (!empty && board_->link_stalled() && !let_time_pass()) { return false; }
    }
    return true;
}

// False: stop.
bool SimSource::let_time_pass() {
    if (!wait_for_call(realtime_ ? tick_ns : 0) || !answer_calls()) { return false; }
    board_->advance_to(realtime_ ? board_ns_of_now() : board_->now_ns() + step_ns);
    return true;
}

// What the endpoint holds, in transfers as large as they come, as long as at least so much is there.
bool SimSource::deliver_bytes(std::size_t at_least) {
    while (board_->in_endpoint().pending_bytes() >= at_least) {
        const std::size_t size = board_->in_endpoint().take_bytes(buffer_);
        if (!deliver_in(ByteView(buffer_).first(size), 0)) { return false; }
    }
    return true;
}

bool SimSource::deliver_packets() {
    while (const auto size = board_->in_endpoint().take_transfer(buffer_)) {
        if (!deliver_in(ByteView(buffer_).first(*size), 0)) { return false; }
    }
    return true;
}

bool SimSource::deliver_in(ByteView data, int status) {
    Transfer transfer;
    transfer.kind = TransferKind::bulk;
    transfer.endpoint = board_->endpoints().in;
    transfer.id = next_id_++;
    transfer.requested_bytes = transfer_bytes;
    transfer.event = Transfer::Event::submission;
    transfer.time = last_event_;  // it was posted ever since
    if (!hand_over(transfer)) { return false; }
    transfer.event = Transfer::Event::completion;
    transfer.status = status;
    // In simulated time a transfer is complete when its last byte comes, not when somebody looks.
    const bool all = !realtime_ && !data.empty() && board_->in_endpoint().pending_bytes() == 0;
    const HostTime now = all ? host_time_of(board_->last_write_ns()) : host_time();
    if (now.monotonic_ns > last_event_.monotonic_ns) { last_event_ = now; }
    transfer.time = last_event_;
    transfer.data = data;
    return hand_over(transfer);
}

void SimSource::deliver_pair(TransferKind kind, std::uint8_t endpoint,
                             const std::array<std::uint8_t, 8>& setup, ByteView data) {
    Transfer transfer;
    transfer.kind = kind;
    transfer.endpoint = endpoint;
    transfer.id = next_id_++;
    transfer.requested_bytes = static_cast<std::uint32_t>(data.size());
    transfer.setup = setup;
    transfer.time = last_event_ = host_time();
    transfer.event = Transfer::Event::submission;
    transfer.data = data;
    hand_over(transfer);
    transfer.event = Transfer::Event::completion;
    transfer.data = {};
    hand_over(transfer);
}

// Waits for room. False: the caller wants to stop, and there is still none.
bool SimSource::hand_over(Transfer& transfer) {
    while (!sink_->on_transfer(transfer)) {
        if (stopping()) { return false; }
        std::this_thread::sleep_for(std::chrono::nanoseconds(retry_ns));
    }
    return true;
}

std::int64_t SimSource::board_ns_of_now() const {
    return host_now().monotonic_ns - origin_.monotonic_ns + origin_board_ns_;
}

HostTime SimSource::host_time() const { return realtime_ ? host_now() : host_time_of(board_->now_ns()); }

HostTime SimSource::host_time_of(std::int64_t board_ns) const {
    const std::int64_t since_start_ns = board_ns - origin_board_ns_;
    return {origin_.monotonic_ns + since_start_ns, origin_.realtime_ns + since_start_ns};
}

bool SimSource::stopping() {
    const std::lock_guard lock(mutex_);
    return stop_wanted_;
}

}  // namespace gyrolog
