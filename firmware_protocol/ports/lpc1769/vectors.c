// Vectors, and the second memory.
#include <stddef.h>

#include "../../src/memory.h"
#include "handlers.h"
#include "registers.h"
#include "startup.h"

extern uint32_t stack_top[];
extern const uint8_t vector_checksum[];  // its address is the number
extern uint8_t ahb_begin[];
extern uint8_t ahb_end[];

void reset(void) {
    startup_fill_memory();
    memset(ahb_begin, 0, (size_t)(ahb_end - ahb_begin));
    run();
}

typedef void (*handler)(void);
typedef struct vectors {
    uint32_t* stack;
    handler core[6];
    const uint8_t* checksum;
    handler rest_of_core[8];
    handler device[INTERRUPT_COUNT];
} vectors;

__attribute__((section(".vectors"), used)) const vectors vector_table = {
    .stack = stack_top,
    .core = {reset, startup_halt, startup_halt, startup_halt, startup_halt, startup_halt},
    .checksum = vector_checksum,
    .rest_of_core = {0, 0, 0, startup_halt, startup_halt, 0, startup_halt, startup_halt},
    .device = {[TIMER2_IRQn] = on_data_ready_capture, [USB_IRQn] = on_usb}};
