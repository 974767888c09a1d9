/// The board as a USB device (SPEC.md, USB): CDC-ACM on full speed.
#ifndef GYROLOG_PROTOCOL_USB_IDENTITY_H
#define GYROLOG_PROTOCOL_USB_IDENTITY_H

#define GLP_USB_VENDOR_ID 0x1FC9U
#define GLP_USB_PRODUCT_ID 0x0083U
/// A host that finds another VID:PID still takes the device when its product string begins with this.
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

#endif
