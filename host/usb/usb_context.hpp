// libusb and the one thread that runs all of its callbacks.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "host/base/call_queue.hpp"
#include "host/base/result.hpp"

struct libusb_context;
struct libusb_transfer;

namespace gyrolog {

// Whoever waits for a callback of libusb. Told on the event thread, once: no callback comes any more.
class EventFailureListener {
public:
    virtual ~EventFailureListener() = default;
    virtual void on_event_failure(const Error& error) = 0;
};

// Every submission, cancellation and completion happens on the event thread, so the state of streams needs no
// lock, and what is told of transfers is told in the order in which the kernel saw them.
//
// When libusb cannot handle events, that is ridden out for a second; a context that cannot do so for longer
// has failed for good. It then tells all who wait, and handles no more events.
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

    // The following: event thread only.
    //
    // Why nothing can be submitted any more; empty while all is well.
    const std::optional<Error>& failure() const { return failure_; }
    // From the first submission to the last callback. Not after a failure.
    void add(EventFailureListener& listener) { listeners_.push_back(&listener); }
    void remove(EventFailureListener& listener);
    // A transfer in flight at the failure is libusb's until its device is closed: it is freed with the
    // context.
    void keep(libusb_transfer* transfer) { kept_.push_back(transfer); }

private:
    explicit UsbContext(libusb_context* context);
    void handle_events();
    void judge(int code);

    libusb_context* context_;
    std::atomic<bool> quit_{false};
    std::uint64_t last_transfer_id_ = 0;
    std::vector<EventFailureListener*> listeners_;
    std::vector<libusb_transfer*> kept_;
    std::optional<std::int64_t> failing_since_ns_;
    std::optional<Error> failure_;
    CallQueue calls_;
    std::thread thread_;
};

}  // namespace gyrolog
