#include "host/usb/usb_device.hpp"

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <mutex>
#include <string>
#include <utility>

#include <gyrolog_protocol/usb_identity.h>
#include <libusb.h>

#include "host/usb/usb_status.hpp"

namespace gyrolog {
namespace {

constexpr unsigned control_timeout_ms = 1000;
constexpr std::size_t write_chunk_bytes = 16384;  // what libusb hands to the kernel as one request
constexpr std::uint8_t request_type_class_interface_out = 0x21;

struct TransferDeleter {
    void operator()(libusb_transfer* transfer) const { libusb_free_transfer(transfer); }
};
using TransferPointer = std::unique_ptr<libusb_transfer, TransferDeleter>;

// One transfer that its caller waits for. libusb's own blocking calls would do, but they report to the
// caller's thread, which may be later than the data that the request has set free.
class AwaitedTransfer final : private EventFailureListener {
public:
    AwaitedTransfer(UsbContext& usb, TransferObserver& observer) : usb_(usb), observer_(observer) {}

    // `transfer` is filled except for its callback; `told` says what it is. Returns an enum libusb_error.
    int run(TransferPointer& transfer, Transfer told) {
        transfer_ = &transfer;
        transfer->callback = [](libusb_transfer* completed) {
            static_cast<AwaitedTransfer*>(completed->user_data)->on_complete(*completed);
        };
        transfer->user_data = this;
        int code = LIBUSB_SUCCESS;
        usb_.call([&] {
            told.time = host_now();
            code = usb_.failure() ? LIBUSB_ERROR_IO : libusb_submit_transfer(transfer.get());
            if (code != LIBUSB_SUCCESS) { return; }
            usb_.add(*this);
            told.id = usb_.next_transfer_id();
            observer_.on_usb_transfer(told);
            told.data = {};
            told_ = told;
        });
        if (code != LIBUSB_SUCCESS) { return code; }
        std::unique_lock lock(mutex_);
        completed_.wait(lock, [this] { return done_; });
        return code_;
    }

private:
    void on_complete(const libusb_transfer& transfer) {
        usb_.remove(*this);
        finish(kernel_status_of_transfer(transfer.status), code_of(transfer.status));
    }

    // The kernel has copied what was to be sent; its buffer may go.
    void on_event_failure(const Error& /*error*/) override {
        usb_.keep(transfer_->release());
        finish(-ESHUTDOWN, LIBUSB_ERROR_IO);
    }

    void finish(int kernel_status, int code) {
        told_.event = Transfer::Event::completion;
        told_.status = kernel_status;
        told_.time = host_now();
        observer_.on_usb_transfer(told_);
        const std::lock_guard lock(mutex_);
        code_ = code;
        done_ = true;
        completed_.notify_all();
    }

    static int code_of(int status) {
        switch (status) {
            case LIBUSB_TRANSFER_COMPLETED:
                return LIBUSB_SUCCESS;
            case LIBUSB_TRANSFER_TIMED_OUT:
                return LIBUSB_ERROR_TIMEOUT;
            case LIBUSB_TRANSFER_STALL:
                return LIBUSB_ERROR_PIPE;
            case LIBUSB_TRANSFER_NO_DEVICE:
                return LIBUSB_ERROR_NO_DEVICE;
            default:
                return LIBUSB_ERROR_IO;
        }
    }

    UsbContext& usb_;
    TransferObserver& observer_;
    TransferPointer* transfer_ = nullptr;
    Transfer told_;
    int code_ = LIBUSB_SUCCESS;
    std::mutex mutex_;
    std::condition_variable completed_;
    bool done_ = false;
};

Result<libusb_device_handle*> open_at(UsbContext& usb, const UsbBoard& board) {
    libusb_device** list = nullptr;
    const ssize_t count = libusb_get_device_list(usb.get(), &list);
    if (count < 0) { return usb_error("list the USB devices", static_cast<int>(count)); }
    libusb_device_handle* handle = nullptr;
    int code = LIBUSB_ERROR_NO_DEVICE;
    for (ssize_t i = 0; i < count; ++i) {
        if (libusb_get_bus_number(list[i]) == board.bus_number &&
            libusb_get_device_address(list[i]) == board.device_address) {
            code = libusb_open(list[i], &handle);
            break;
        }
    }
    libusb_free_device_list(list, 1);
    if (code != LIBUSB_SUCCESS) { return usb_error("open board '" + board.uri() + "'", code); }
    return handle;
}

}  // namespace

UsbDevice::UsbDevice(UsbContext& usb, libusb_device_handle* handle, UsbBoard board)
    : usb_(usb), handle_(handle), board_(std::move(board)) {}

Result<std::unique_ptr<UsbDevice>> UsbDevice::open(UsbContext& usb, const UsbBoard& board) {
    GYROLOG_TRY(libusb_device_handle * handle, open_at(usb, board));
    std::unique_ptr<UsbDevice> device(new UsbDevice(usb, handle, board));
    // The kernel's cdc_acm holds both interfaces, and lets go of both when the first is taken.
    GYROLOG_CHECK(device->claim(board.layout.control_interface));
    GYROLOG_CHECK(device->claim(board.layout.data_interface));
    return device;
}

// Without libusb's automatic detaching: that fails the claim where the kernel cannot tell which driver is
// bound, while an interface whose driver is unknown can still be claimed.
Status UsbDevice::claim(std::uint8_t interface) {
    const std::string doing =
        "claim interface " + std::to_string(interface) + " of board '" + board_.uri() + "'";
    if (libusb_kernel_driver_active(handle_, interface) == 1) {
        const int code = libusb_detach_kernel_driver(handle_, interface);
        if (code != LIBUSB_SUCCESS && code != LIBUSB_ERROR_NOT_FOUND) {
            return usb_error(doing + " from the kernel's driver", code);
        }
    }
    const int code = libusb_claim_interface(handle_, interface);
    if (code != LIBUSB_SUCCESS) { return usb_error(doing, code); }
    claimed_.push_back(interface);
    return {};
}

UsbDevice::~UsbDevice() {
    // Closing alone leaves the serial port missing until the board is plugged in again. Failures mean that
    // the board is gone, and then there is nothing to give back. cdc_acm binds to the control interface and
    // takes the other along.
    for (const std::uint8_t interface : claimed_) {
        static_cast<void>(libusb_release_interface(handle_, interface));
    }
    // Not only when it was us who took the port away: a program that was killed gave nothing back.
    static_cast<void>(libusb_attach_kernel_driver(handle_, board_.layout.control_interface));
    libusb_close(handle_);
}

Status UsbDevice::set_line_state(bool data_terminal_ready, TransferObserver& observer) {
    std::array<std::uint8_t, LIBUSB_CONTROL_SETUP_SIZE> setup{};
    const std::uint16_t lines = data_terminal_ready ? GLP_CDC_LINE_DTR : 0;
    libusb_fill_control_setup(setup.data(), request_type_class_interface_out, GLP_CDC_SET_CONTROL_LINE_STATE,
                              lines, board_.layout.control_interface, 0);
    TransferPointer transfer(libusb_alloc_transfer(0));
    if (!transfer) { return usb_error("set DTR", LIBUSB_ERROR_NO_MEM); }
    libusb_fill_control_transfer(transfer.get(), handle_, setup.data(), nullptr, nullptr, control_timeout_ms);

    Transfer told;
    told.event = Transfer::Event::submission;
    told.kind = TransferKind::control;
    told.setup = setup;
    const int code = AwaitedTransfer(usb_, observer).run(transfer, told);
    if (code != LIBUSB_SUCCESS) { return usb_error("set DTR", code); }
    return {};
}

Status UsbDevice::write(ByteView bytes, std::int64_t timeout_ms, TransferObserver& observer) {
    const std::int64_t deadline_ns = clock_ns(CLOCK_MONOTONIC) + timeout_ms * 1'000'000;
    TransferPointer transfer(libusb_alloc_transfer(0));
    if (!transfer) { return usb_error("write to the board", LIBUSB_ERROR_NO_MEM); }
    Bytes chunk;
    while (!bytes.empty()) {
        const std::int64_t left_ms = (deadline_ns - clock_ns(CLOCK_MONOTONIC)) / 1'000'000;
        if (left_ms <= 0) { return usb_error("write to the board", LIBUSB_ERROR_TIMEOUT); }
        const std::size_t size = std::min(bytes.size(), write_chunk_bytes);
        chunk.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        libusb_fill_bulk_transfer(transfer.get(), handle_, board_.layout.endpoint_out, chunk.data(),
                                  static_cast<int>(size), nullptr, nullptr, static_cast<unsigned>(left_ms));
        Transfer told;
        told.event = Transfer::Event::submission;
        told.endpoint = board_.layout.endpoint_out;
        told.requested_bytes = static_cast<std::uint32_t>(size);
        told.data = chunk;
        const int code = AwaitedTransfer(usb_, observer).run(transfer, told);
        if (code != LIBUSB_SUCCESS) { return usb_error("write to the board", code); }
        bytes = bytes.subspan(size);
    }
    return {};
}

}  // namespace gyrolog
