#include "usb_controller.h"

#include <fsl_clock.h>
#include <fsl_power.h>
#include <fsl_reset.h>
#include <tusb.h>

#include "handlers.h"

void usb_controller_start(void) {
    POWER_DisablePD(kPDRUNCFG_PD_USB0_PHY);
    RESET_PeripheralReset(kUSB0D_RST_SHIFT_RSTn);
    RESET_PeripheralReset(kUSB0HSL_RST_SHIFT_RSTn);
    RESET_PeripheralReset(kUSB0HMR_RST_SHIFT_RSTn);
    // UM11126, USB0: the port belongs to the host controller until PORTMODE gives it away, which needs that
    // controller's clock.
    CLOCK_EnableClock(kCLOCK_Usbhsl0);
    USBFSH->PORTMODE |= USBFSH_PORTMODE_DEV_ENABLE_MASK;
    CLOCK_DisableClock(kCLOCK_Usbhsl0);
    CLOCK_EnableClock(kCLOCK_Usbd0);
    CLOCK_EnableClock(kCLOCK_UsbRam1);
    NVIC_SetPriority(USB0_IRQn, USB_CONTROLLER_PRIORITY);
}

void usb_controller_poll(void) {}

uint32_t usb_controller_frame_number(void) { return USB0->INFO; }

void on_usb(void) { tusb_int_handler(0, true); }
