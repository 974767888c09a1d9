#include "host/usb/usb_context.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <utility>

#include <libusb.h>
#include <pthread.h>

#include "host/base/clock.hpp"
#include "host/usb/usb_status.hpp"

namespace gyrolog {
namespace {

// The kernel fills what is queued meanwhile: less than the stall_to_ride_out_s that streams queue for.
constexpr std::int64_t failure_to_ride_out_ns = 1'000'000'000;
constexpr std::chrono::milliseconds pause_after_failure(10);

}  // namespace

Result<std::unique_ptr<UsbContext>> UsbContext::create() {
    libusb_context* context = nullptr;
    if (const int code = libusb_init(&context); code != LIBUSB_SUCCESS) {
        return usb_error("start libusb", code);
    }
    return std::unique_ptr<UsbContext>(new UsbContext(context));
}

// libusb remembers an interruption that comes while nobody waits for events, so a wake-up cannot fall between
// run_pending and the wait.
UsbContext::UsbContext(libusb_context* context)
    : context_(context),
      calls_([context] { libusb_interrupt_event_handler(context); }),
      thread_([this] { handle_events(); }) {
    pthread_setname_np(thread_.native_handle(), "gyrolog-usb");
}

UsbContext::~UsbContext() {
    quit_ = true;
    libusb_interrupt_event_handler(context_);
    thread_.join();
    for (libusb_transfer* transfer : kept_) { libusb_free_transfer(transfer); }
    libusb_exit(context_);
}

void UsbContext::call(const std::function<void()>& work) {
    const bool ran = calls_.call(work);
    // Refused means that a device or stream outlived its context.
    if (!ran) { std::abort(); }
}

void UsbContext::handle_events() {
    calls_.adopt();
    while (!quit_) {
        calls_.run_pending();
        if (failure_) {
            std::this_thread::sleep_for(pause_after_failure);
            continue;
        }
        // Only a bound, in case libusb has no timer of its own; callbacks, calls and quitting end the wait.
        timeval wait{1, 0};
        judge(libusb_handle_events_timeout_completed(context_, &wait, nullptr));
    }
    calls_.close();
}

void UsbContext::judge(int code) {
    if (code == LIBUSB_SUCCESS || code == LIBUSB_ERROR_INTERRUPTED || code == LIBUSB_ERROR_TIMEOUT) {
        failing_since_ns_.reset();
        return;
    }
    const std::int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
    if (!failing_since_ns_) { failing_since_ns_ = now_ns; }
    if (now_ns - *failing_since_ns_ < failure_to_ride_out_ns) {
        std::this_thread::sleep_for(pause_after_failure);
        return;
    }
    failure_ = {ErrorCode::device_lost, usb_error("wait for what USB brings", code).message};
    // The youngest first: a stream tells the end of all.
    std::vector<EventFailureListener*> all = std::exchange(listeners_, {});
    std::ranges::reverse(all);
    for (EventFailureListener* listener : all) { listener->on_event_failure(*failure_); }
}

void UsbContext::remove(EventFailureListener& listener) { std::erase(listeners_, &listener); }

}  // namespace gyrolog
