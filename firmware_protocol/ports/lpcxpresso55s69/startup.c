// Vectors, and memory as C expects it.
#include <fsl_device_registers.h>
#include <stdint.h>

#include "../../src/memory.h"
#include "handlers.h"

extern uint32_t stack_top[];
extern uint32_t stack_limit[];
extern uint8_t data_begin[];
extern uint8_t data_end[];
extern const uint8_t data_load[];
extern uint8_t bss_begin[];
extern uint8_t bss_end[];

void reset(void) {
    __set_MSPLIM((uint32_t)stack_limit);
    memcpy(data_begin, data_load, (size_t)(data_end - data_begin));
    memset(bss_begin, 0, (size_t)(bss_end - bss_begin));
    run();
}

// Nothing feeds the watchdog here: the part resets, and HELLO tells why.
static void halt(void) {
    __disable_irq();
    for (;;) {}
}

typedef void (*handler)(void);
typedef struct vectors {
    uint32_t* stack;
    handler core[15];
    handler device[60];
} vectors;

// The boot ROM takes the words at 0x20 and 0x24 for length and type of the image; 0 is a plain image
// (UM11126, boot ROM, image header).
__attribute__((section(".vectors"), used)) static const vectors table = {
    .stack = stack_top,
    .core = {reset, halt, halt, halt, halt, halt, halt, 0, 0, 0, halt, halt, 0, halt, halt},
    .device = {[CTIMER0_IRQn] = on_data_ready_capture, [USB0_IRQn] = on_usb}};
