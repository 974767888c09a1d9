#include "host/usb/usb_status.hpp"

#include <cerrno>

#include <libusb.h>

namespace gyrolog {

int kernel_status_of_transfer(int status) {
    switch (status) {
        case LIBUSB_TRANSFER_COMPLETED:
            return 0;
        case LIBUSB_TRANSFER_STALL:
            return -EPIPE;
        case LIBUSB_TRANSFER_OVERFLOW:
            return -EOVERFLOW;
        case LIBUSB_TRANSFER_NO_DEVICE:
            return -ESHUTDOWN;
        // A timeout is libusb's: to the kernel it is one more transfer that was cancelled.
        case LIBUSB_TRANSFER_TIMED_OUT:
        case LIBUSB_TRANSFER_CANCELLED:
            return -ENOENT;
        default:
            return -EPROTO;
    }
}

namespace {

ErrorCode code_of_libusb(int code) {
    switch (code) {
        case LIBUSB_ERROR_ACCESS:
            return ErrorCode::permission_denied;
        case LIBUSB_ERROR_NO_DEVICE:
            return ErrorCode::device_lost;
        case LIBUSB_ERROR_NOT_FOUND:
            return ErrorCode::not_found;
        case LIBUSB_ERROR_BUSY:
            return ErrorCode::busy;
        case LIBUSB_ERROR_TIMEOUT:
            return ErrorCode::timeout;
        case LIBUSB_ERROR_NOT_SUPPORTED:
        case LIBUSB_ERROR_PIPE:
            return ErrorCode::unsupported;
        case LIBUSB_ERROR_INVALID_PARAM:
            return ErrorCode::invalid_argument;
        default:
            return ErrorCode::failed;
    }
}

// Not libusb_strerror: it needs libusb at run time for a text, and its capitals do not fit into a sentence.
const char* words_of(int code) {
    switch (code) {
        case LIBUSB_ERROR_ACCESS:
            return "permission denied";
        case LIBUSB_ERROR_NO_DEVICE:
            return "the device went away";
        case LIBUSB_ERROR_NOT_FOUND:
            return "not found";
        case LIBUSB_ERROR_BUSY:
            return "in use by another program";
        case LIBUSB_ERROR_TIMEOUT:
            return "no answer in time";
        case LIBUSB_ERROR_PIPE:
            return "refused by the device (stall)";
        case LIBUSB_ERROR_NO_MEM:
            return "no USB memory left; raise /sys/module/usbcore/parameters/usbfs_memory_mb";
        case LIBUSB_ERROR_OVERFLOW:
            return "the device sent more than was asked for";
        case LIBUSB_ERROR_NOT_SUPPORTED:
            return "not supported by this system";
        case LIBUSB_ERROR_INVALID_PARAM:
            return "the kernel refused the request";
        default:
            return "input/output error";
    }
}

}  // namespace

Error usb_error(const std::string& doing, int code) {
    return {code_of_libusb(code), doing + ": " + words_of(code)};
}

}  // namespace gyrolog
