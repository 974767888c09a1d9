// libusb and the one thread that runs all of its callbacks.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "host/base/call_queue.hpp"
#include "host/base/result.hpp"

struct libusb_context;

namespace gyrolog {

// Every submission, cancellation and completion happens on the event thread, so the state of streams needs no
// lock, and what is told of transfers is told in the order in which the kernel saw them.
//
// Lifetime: outlives every UsbDevice and BulkInStream made with it.
class UsbContext {
public:
    static Result<std::unique_ptr<UsbContext>> create();
    UsbContext(const UsbContext&) = delete;
    UsbContext& operator=(const UsbContext&) = delete;
    ~UsbContext();

    libusb_context* get() const { return context_; }

    // Runs `work` on the event thread and returns when it has run; at once when called from a callback.
    void call(const std::function<void()>& work);

    // A number no other transfer of this context has had. Event thread only.
    std::uint64_t next_transfer_id() { return ++last_transfer_id_; }

private:
    explicit UsbContext(libusb_context* context);
    void handle_events();

    libusb_context* context_;
    std::atomic<bool> quit_{false};
    std::uint64_t last_transfer_id_ = 0;
    CallQueue calls_;
    std::thread thread_;
};

}  // namespace gyrolog
