// Vectors, and memory as C expects it.
#include <stdint.h>

#include "../../src/memory.h"
#include "handlers.h"
#include "registers.h"

extern uint32_t stack_top[];
extern uint8_t data_begin[];
extern uint8_t data_end[];
extern const uint8_t data_load[];
extern uint8_t bss_begin[];
extern uint8_t bss_end[];

void reset(void) {
    memcpy(data_begin, data_load, (size_t)(data_end - data_begin));
    memset(bss_begin, 0, (size_t)(bss_end - bss_begin));
    run();
}

// A fault stops here, for a debugger to find.
static void halt(void) {
    for (;;) {}
}

typedef void (*handler)(void);
typedef struct vectors {
    uint32_t* stack;
    handler core[15];
    handler device[64];
} vectors;

__attribute__((section(".vectors"), used)) static const vectors table = {
    .stack = stack_top,
    .core = {reset, halt, halt, halt, halt, halt, 0, 0, 0, 0, halt, halt, 0, halt, halt},
    .device = {[irq_uart0_receive] = on_uart_receive, [irq_timer1] = on_sample_timer}};
