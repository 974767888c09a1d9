#include "usb_controller.h"

#include <portable/nxp/lpc17_40/dcd_lpc17_40.h>
#include <tusb.h>

#include "handlers.h"
#include "port.h"
#include "registers.h"
#include "sample_timer.h"

enum {
    SIE_LIMIT_TICKS = CORE_HZ / 10000U,  // a command takes a few microseconds
    UNHEARD_TICKS = CORE_HZ / 1000U,     // no packet of a host that takes any waits as long
    BUFFERS_FULL = SIE_SELECT_ENDPOINT_BUFFER1_FULL_MASK | SIE_SELECT_ENDPOINT_BUFFER2_FULL_MASK
};
#define IN_ENDPOINTS 0xAAAAAAA8UL  // odd indices, without control's

static uint32_t waiting_for;
static uint32_t waiting_since;

// UM10360, 11.12. The driver's interrupt uses the same registers: its caller keeps it away.
static bool sie(sie_cmdphase_t phase, uint32_t code, uint32_t wait_for) {
    LPC_USB->DevIntClr = DEV_INT_COMMAND_CODE_EMPTY_MASK | DEV_INT_COMMAND_DATA_FULL_MASK;
    LPC_USB->CmdCode = ((uint32_t)phase << 8U) | (code << 16U);
    const uint32_t begin = sample_timer_now();
    while ((LPC_USB->DevIntSt & wait_for) == 0U) {
        if (sample_timer_now() - begin > SIE_LIMIT_TICKS) { return false; }
    }
    LPC_USB->DevIntClr = wait_for;
    return true;
}

// `count` bytes, the first one the lowest; 0 when the controller does not answer.
static uint32_t sie_read(uint32_t code, unsigned count) {
    uint32_t value = 0;
    bool done = sie(SIE_CMDPHASE_COMMAND, code, DEV_INT_COMMAND_CODE_EMPTY_MASK);
    for (unsigned i = 0; done && (i < count); ++i) {
        done = sie(SIE_CMDPHASE_READ, code, DEV_INT_COMMAND_DATA_FULL_MASK);
        if (done) { value |= (LPC_USB->CmdData & 0xFFU) << (8U * i); }
    }
    return done ? value : 0U;
}

void usb_controller_start(void) {
    LPC_USB->USBClkCtrl = USBCLK_DEVICE | USBCLK_AHB;
    while ((LPC_USB->USBClkSt & (USBCLK_DEVICE | USBCLK_AHB)) != (USBCLK_DEVICE | USBCLK_AHB)) {}
    NVIC_SetPriority(USB_IRQn, USB_CONTROLLER_PRIORITY);
}

// The driver learns that a transfer has left by an endpoint interrupt that it enables when the DMA has handed
// over the last packet. A host that takes this packet sooner than the driver enables the interrupt is not
// heard, for until then the event raises a DMA request (UM10360, 11.10.3, USBEpIntEn), and the transfer would
// never end. What has waited for long with both buffers empty is told anew.
static void tell_unheard(uint32_t endpoint) {
    const uint32_t index = 31U - (uint32_t)__builtin_clz(endpoint);
    const bool all_taken = (sie_read(SIE_CMDCODE_ENDPOINT_SELECT + index, 1U) & BUFFERS_FULL) == 0U;
    if (all_taken && ((LPC_USB->EpIntEn & ~LPC_USB->EpIntSt & endpoint) != 0U)) {
        LPC_USB->EpIntSet = endpoint;
    }
}

void usb_controller_poll(void) {
    const uint32_t waiting = LPC_USB->EpIntEn & ~LPC_USB->EpIntSt & IN_ENDPOINTS;
    const uint32_t now = sample_timer_now();
    if ((waiting == 0U) || (waiting != waiting_for)) {
        waiting_for = waiting;
        waiting_since = now;
        return;
    }
    if (now - waiting_since < UNHEARD_TICKS) { return; }
    waiting_since = now;
    NVIC_DisableIRQ(USB_IRQn);
    tell_unheard(waiting & (0U - waiting));
    NVIC_EnableIRQ(USB_IRQn);
}

uint32_t usb_controller_frame_number(void) {
    NVIC_DisableIRQ(USB_IRQn);
    const uint32_t number = sie_read(SIE_CMDCODE_READ_FRAME_NUMBER, 2U);
    NVIC_EnableIRQ(USB_IRQn);
    return number;
}

void on_usb(void) { tusb_int_handler(0, true); }
