// Vectors.
#include <fsl_device_registers.h>
#include <stdint.h>

#include "handlers.h"
#include "startup.h"

extern uint32_t stack_top[];
extern uint32_t stack_limit[];

void reset(void) {
    __set_MSPLIM((uint32_t)stack_limit);
    startup_fill_memory();
    run();
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
    .core = {reset, startup_halt, startup_halt, startup_halt, startup_halt, startup_halt, startup_halt, 0, 0,
             0, startup_halt, startup_halt, 0, startup_halt, startup_halt},
    .device = {[CTIMER0_IRQn] = on_data_ready_capture, [USB0_IRQn] = on_usb}};
