#include "host/transport/usb_source.hpp"

#include <utility>

namespace gyrolog {
namespace {

constexpr std::int64_t write_timeout_ms = 1000;

SourceIdentity identity_of_board(const UsbBoard& board) {
    return {board.uri(),
            board.vendor_id,
            board.product_id,
            board.bus_number,
            board.device_address,
            board.manufacturer,
            board.product,
            board.serial,
            board.device_descriptor,
            board.configuration_descriptor};
}

SourceEnd source_end_of(BulkInStream::End end) {
    switch (end) {
        case BulkInStream::End::stopped:
            return SourceEnd::stopped;
        case BulkInStream::End::device_lost:
            return SourceEnd::device_lost;
        case BulkInStream::End::failed:
            return SourceEnd::failed;
    }
    return SourceEnd::failed;
}

}  // namespace

Result<std::unique_ptr<UsbSource>> UsbSource::open(std::shared_ptr<UsbContext> usb, const UsbBoard& board,
                                                   BulkInPlan plan) {
    // A request that is not whole packets could be overrun by the last one.
    if (plan.transfers == 0 || plan.transfer_bytes == 0 ||
        plan.transfer_bytes % board.layout.packet_in_bytes != 0) {
        return Error{ErrorCode::invalid_argument,
                     "open board '" + board.uri() + "': transfers must be whole packets of " +
                         std::to_string(board.layout.packet_in_bytes) + " bytes"};
    }
    GYROLOG_TRY(std::unique_ptr<UsbDevice> device, UsbDevice::open(*usb, board));
    return std::unique_ptr<UsbSource>(new UsbSource(std::move(usb), std::move(device), plan));
}

Result<std::unique_ptr<UsbSource>> UsbSource::open(std::shared_ptr<UsbContext> usb, std::string_view serial,
                                                   BulkInPlan plan) {
    GYROLOG_TRY(const UsbSurvey survey, survey_usb(*usb));
    GYROLOG_TRY(const UsbBoard board, choose_board(survey, serial));
    return open(std::move(usb), board, plan);
}

UsbSource::UsbSource(std::shared_ptr<UsbContext> usb, std::unique_ptr<UsbDevice> device, BulkInPlan plan)
    : usb_(std::move(usb)), plan_(plan) {
    use(std::move(device));
}

void UsbSource::use(std::unique_ptr<UsbDevice> device) {
    device_ = std::move(device);
    identity_ = identity_of_board(device_->board());
    TransferObserver& self = *this;
    stream_ = std::make_unique<BulkInStream>(*usb_, device_->handle(), device_->board().layout.endpoint_in,
                                             plan_, self);
    device_lost_ = false;
    line_raised_ = false;
}

Error UsbSource::gone() const { return {ErrorCode::device_lost, identity_.uri + ": the board is gone"}; }

UsbSource::~UsbSource() { UsbSource::let_go(); }

void UsbSource::let_go() {
    UsbSource::stop();
    if (device_ && line_raised_ && !device_lost_) { static_cast<void>(UsbSource::set_line_state(false)); }
    stream_.reset();
    device_.reset();
}

double UsbSource::tolerated_stall_s(double bytes_per_s, double bytes_per_frame) const {
    return stream_ ? stream_->capacity_bytes(bytes_per_frame) / bytes_per_s : 0.0;
}

void UsbSource::expect(double bytes_per_s, double bytes_per_frame) {
    if (!stream_ || tolerated_stall_s(bytes_per_s, bytes_per_frame) >= stall_to_ride_out_s) { return; }
    stream_->deepen(BulkInPlan::for_stream(bytes_per_s, bytes_per_frame, stall_to_ride_out_s));
}

Status UsbSource::start(TransferSink& sink) {
    if (!stream_) { return gone(); }
    usb_->call([&] { sink_ = &sink; });
    // A board that refuses the request has no line state; it is quiet until it gets a START command.
    Status begun = set_line_state(false);
    if (begun.ok() || begun.error().code == ErrorCode::unsupported) {
        begun = stream_->start([this](BulkInStream::End end, const std::optional<Error>& error) {
            device_lost_ = end == BulkInStream::End::device_lost;
            // Nothing may be told after the end.
            std::exchange(sink_, nullptr)->on_end(source_end_of(end), error);
        });
    }
    if (!begun.ok()) {
        usb_->call([this] { sink_ = nullptr; });
        return begun;
    }
    silence_.await([this](std::int64_t time_ns) {
        constexpr std::int64_t ns_per_ms = 1'000'000;
        if (stream_->wait_for_end((time_ns + ns_per_ms - 1) / ns_per_ms)) { return true; }
        // On a busy machine the event thread may have yet to tell what has come.
        usb_->call([] {});
        return false;
    });
    return {};
}

Status UsbSource::set_line_state(bool data_terminal_ready) {
    if (!device_) { return gone(); }
    GYROLOG_CHECK(device_->set_line_state(data_terminal_ready, *this));
    line_raised_ = data_terminal_ready;
    return {};
}

Status UsbSource::write(ByteView bytes) {
    if (!device_) { return gone(); }
    return device_->write(bytes, write_timeout_ms, *this);
}

void UsbSource::stop() {
    if (stream_) { stream_->stop(); }
}

// The old handle goes before the new one comes: its interfaces are then free for whoever is next.
Status UsbSource::reconnect() {
    let_go();
    // A context of its own: where no udev daemon runs, an old one does not hear of new devices.
    GYROLOG_TRY(std::shared_ptr<UsbContext> usb, UsbContext::create());
    GYROLOG_TRY(const UsbSurvey survey, survey_usb(*usb));
    auto chosen = choose_board(survey, identity_.serial);
    // It was a board before: the kernel is still taking the old one away, or has not yet read the new one.
    if (!chosen.ok() && chosen.error().code == ErrorCode::unsupported) {
        return Error{ErrorCode::busy, chosen.error().message};
    }
    GYROLOG_TRY(const UsbBoard board, std::move(chosen));
    if (plan_.transfer_bytes % board.layout.packet_in_bytes != 0) {
        return Error{ErrorCode::unsupported, "open board '" + board.uri() + "': its packets have changed"};
    }
    GYROLOG_TRY(std::unique_ptr<UsbDevice> device, UsbDevice::open(*usb, board));
    usb_ = std::move(usb);
    use(std::move(device));
    return {};
}

void UsbSource::on_usb_transfer(const Transfer& transfer) {
    if (transfer.carries_stream() && !transfer.data.empty()) { silence_.heard(); }
    // A full sink has counted what it refused. The bus does not wait, so there is no second try.
    if (sink_ != nullptr) { static_cast<void>(sink_->on_transfer(transfer)); }
}

}  // namespace gyrolog
