/// TinyUSB as this port uses it: one CDC-ACM function on the full-speed controller.
#ifndef GYROLOG_PORT_LPC1769_TUSB_CONFIG_H
#define GYROLOG_PORT_LPC1769_TUSB_CONFIG_H

#define CFG_TUSB_MCU OPT_MCU_LPC175X_6X
#define CFG_TUSB_OS OPT_OS_NONE
#define CFG_TUSB_DEBUG 0
#define CFG_TUSB_RHPORT0_MODE (OPT_MODE_DEVICE | OPT_MODE_FULL_SPEED)
#define CFG_TUD_ENABLED 1
#define CFG_TUD_MAX_SPEED OPT_MODE_FULL_SPEED
#define CFG_TUD_ENDPOINT0_SIZE 64
// UM10360, chapter 2: the controller's DMA reaches the second memory, not the first.
#define CFG_TUSB_MEM_SECTION __attribute__((section(".bss.ahb.usb")))
#define CFG_TUSB_MEM_ALIGN __attribute__((aligned(4)))

#define CFG_TUD_CDC 1
#define CFG_TUD_CDC_NOTIFY 0
#define CFG_TUD_CDC_RX_BUFSIZE 512
#define CFG_TUD_CDC_TX_BUFSIZE 512
// One transfer takes what the FIFO holds; the DMA cuts it into packets, so that a long read of the sensor
// does not hold the link up.
#define CFG_TUD_CDC_TX_EPSIZE 512
// What was accepted is sent or dropped at a reset, never overwritten in the middle: SPEC 8.2, 8.4.
#define CFG_TUD_CDC_TX_OVERWRITABLE_IF_NOT_CONNECTED 0

#endif
