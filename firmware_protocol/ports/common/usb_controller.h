/// What usb_link asks of the port's USB controller, beside TinyUSB's driver for it.
#ifndef GYROLOG_PORT_USB_CONTROLLER_H
#define GYROLOG_PORT_USB_CONTROLLER_H

#include <stdint.h>

#define USB_CONTROLLER_PRIORITY 1U  ///< Of the interrupt: below the capture of the sensor's line

/// Power, clock and interrupt priority, before TinyUSB's driver starts.
void usb_controller_start(void);
/// With each turn of the main loop, behind TinyUSB's task.
void usb_controller_poll(void);
/// Number of the last start-of-frame token, 11 bits. Only while the board is configured and not suspended.
uint32_t usb_controller_frame_number(void);

#endif
