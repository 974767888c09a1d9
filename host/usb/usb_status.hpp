// libusb's codes, told in this project's terms.
#pragma once

#include <string>

#include "host/base/result.hpp"

namespace gyrolog {

// The status a completed transfer is recorded with: the negative errno that the kernel's USB stack reports
// for it (Documentation/driver-api/usb/error-codes), 0 when it went well. `status` is an enum
// libusb_transfer_status.
int kernel_status_of_transfer(int status);

// "`doing`: <what libusb says>", with the ErrorCode that fits. `code` is an enum libusb_error.
Error usb_error(const std::string& doing, int code);

}  // namespace gyrolog
