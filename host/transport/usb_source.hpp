// A board on USB, as a byte source.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string_view>

#include "host/transport/byte_source.hpp"
#include "host/transport/line_silence.hpp"
#include "host/usb/bulk_in_stream.hpp"
#include "host/usb/usb_device.hpp"

namespace gyrolog {

// Every transfer this program makes is told to the sink on libusb's event thread in the kernel's order: line
// state, writes and stream alike. A capture of them can therefore be served to the same program again by
// umockdev.
//
// start() lowers DTR and returns when the line has fallen silent; the stale bytes that came meanwhile are
// told like any others. Raising DTR is the caller's. A start that fails tells no end. write() and
// set_line_state() must not be called from the sink. After stop() they still work but are told to nobody.
class UsbSource final : public ByteSource, private TransferObserver {
public:
    static Result<std::unique_ptr<UsbSource>> open(std::shared_ptr<UsbContext> usb, const UsbBoard& board,
                                                   BulkInPlan plan = BulkInPlan::for_unknown_stream());
    // The board with this serial number, or the only one there is.
    static Result<std::unique_ptr<UsbSource>> open(std::shared_ptr<UsbContext> usb, std::string_view serial,
                                                   BulkInPlan plan = BulkInPlan::for_unknown_stream());
    UsbSource(const UsbSource&) = delete;
    UsbSource& operator=(const UsbSource&) = delete;
    // Stops, and lowers DTR if it is still raised: a board nobody listens to need not talk.
    ~UsbSource() override;

    const SourceIdentity& identity() const override { return identity_; }
    bool can_wait() const override { return false; }
    double tolerated_stall_s(double bytes_per_s, double bytes_per_frame) const override;
    void expect(double bytes_per_s, double bytes_per_frame) override;

    Status start(TransferSink& sink) override;
    Status set_line_state(bool data_terminal_ready) override;
    Status write(ByteView bytes) override;
    void stop() override;
    Status reconnect() override;
    void let_go() override;

private:
    UsbSource(std::shared_ptr<UsbContext> usb, std::unique_ptr<UsbDevice> device, BulkInPlan plan);
    void on_usb_transfer(const Transfer& transfer) override;
    void use(std::unique_ptr<UsbDevice> device);
    Error gone() const;

    std::shared_ptr<UsbContext> usb_;
    BulkInPlan plan_;
    SourceIdentity identity_;
    // Both are null between the loss of a board and its return, and once it was let go.
    std::unique_ptr<UsbDevice> device_;
    std::unique_ptr<BulkInStream> stream_;  // goes first
    TransferSink* sink_ = nullptr;          // the event thread's; null when nobody is to be told
    LineSilence silence_;
    std::atomic<bool> device_lost_{false};
    std::atomic<bool> line_raised_{false};
};

}  // namespace gyrolog
