#include "host/usb/usb_context.hpp"

#include <cstdlib>

#include <libusb.h>
#include <pthread.h>

#include "host/usb/usb_status.hpp"

namespace gyrolog {

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
        // Only a bound, in case libusb has no timer of its own; callbacks, calls and quitting end the wait.
        timeval wait{1, 0};
        libusb_handle_events_timeout_completed(context_, &wait, nullptr);
    }
    calls_.close();
}

}  // namespace gyrolog
