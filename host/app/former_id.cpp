#include "host/app/former_id.hpp"

#include <fmt/format.h>
#include <gyrolog_protocol/usb_identity.h>

#include "host/app/command.hpp"

namespace gyrolog {

void warn_of_former_id(Console& console, const char* command, const std::string& uri, std::uint16_t vendor_id,
                       std::uint16_t product_id) {
    if (glp_usb_id_of(vendor_id, product_id) != glp_usb_id_former) { return; }
    say_warning(
        console, command,
        fmt::format("{} has the id {:04x}:{:04x}, which NXP's example of a serial port has as well; new "
                    "firmware has {:04x}:{:04x}",
                    uri, vendor_id, product_id, GLP_USB_VENDOR_ID, GLP_USB_PRODUCT_ID));
}

void warn_of_former_id(Console& console, const char* command, const SourceIdentity& identity) {
    if (!identity.uri.starts_with("usb:") && !identity.uri.starts_with("tty:")) { return; }
    warn_of_former_id(console, command, identity.uri, identity.vendor_id, identity.product_id);
}

}  // namespace gyrolog
