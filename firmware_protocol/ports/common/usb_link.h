/// The USB side of the board: CDC-ACM of SPEC section 10 on TinyUSB's device stack.
#ifndef GYROLOG_PORT_USB_LINK_H
#define GYROLOG_PORT_USB_LINK_H

#include <gyrolog_protocol/message.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// `on_line_state` is called from usb_link_poll with each change of DTR. A bus reset, a suspend and an
/// unplugged cable are a falling one. `uid` becomes the serial string.
void usb_link_start(const uint8_t uid[GLP_UID_BYTES], void (*on_line_state)(bool dtr));
void usb_link_poll(void);
bool usb_link_configured(void);
size_t usb_link_read(uint8_t* bytes, size_t size);
/// Neither waits: what is not accepted stays the caller's.
size_t usb_link_write(const uint8_t* bytes, size_t size);
void usb_link_flush(void);
/// Start-of-frame tokens since the start, where usb_link_poll runs at least every two seconds.
uint32_t usb_link_frame_number(void);

#endif
