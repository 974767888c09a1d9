/// The board as a USB device (SPEC.md, USB): CDC-ACM on full speed.
#ifndef GYROLOG_PROTOCOL_USB_IDENTITY_H
#define GYROLOG_PROTOCOL_USB_IDENTITY_H

#include <stdbool.h>
#include <stdint.h>

/// Asked for at pid.codes, and not granted yet: firmware_protocol/USB_ID.md.
#define GLP_USB_VENDOR_ID 0x1209U
#define GLP_USB_PRODUCT_ID 0x6779U
/// The id until November 2026, which NXP's example of a serial port has as well. Not for new firmware.
#define GLP_USB_FORMER_VENDOR_ID 0x1FC9U
#define GLP_USB_FORMER_PRODUCT_ID 0x0083U
/// The product string begins with this. A host takes a device only when its id and its product string are
/// both right.
#define GLP_USB_PRODUCT_PREFIX "gyrolog"
#define GLP_USB_INTERFACE_CONTROL 0U
#define GLP_USB_INTERFACE_DATA 1U
#define GLP_USB_PACKET_BYTES 64U
/// CDC PSTN requests (class, interface).
#define GLP_CDC_SET_LINE_CODING 0x20U
#define GLP_CDC_GET_LINE_CODING 0x21U
#define GLP_CDC_SET_CONTROL_LINE_STATE 0x22U
#define GLP_CDC_LINE_DTR 0x0001U
#define GLP_CDC_LINE_RTS 0x0002U

typedef enum glp_usb_id {
    glp_usb_id_other,   ///< Somebody else's
    glp_usb_id_former,  ///< A board's, or that of a device made from NXP's example
    glp_usb_id_own
} glp_usb_id;

static inline glp_usb_id glp_usb_id_of(uint16_t vendor_id, uint16_t product_id) {
    if ((vendor_id == GLP_USB_VENDOR_ID) && (product_id == GLP_USB_PRODUCT_ID)) { return glp_usb_id_own; }
    const bool former = (vendor_id == GLP_USB_FORMER_VENDOR_ID) && (product_id == GLP_USB_FORMER_PRODUCT_ID);
    return former ? glp_usb_id_former : glp_usb_id_other;
}

#endif
