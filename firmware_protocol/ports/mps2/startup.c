// Vectors.
#include "../common/startup.h"

#include <stdint.h>

#include "handlers.h"
#include "registers.h"

extern uint32_t stack_top[];

void reset(void) {
    startup_fill_memory();
    run();
}

typedef void (*handler)(void);
typedef struct vectors {
    uint32_t* stack;
    handler core[15];
    handler device[64];
} vectors;

__attribute__((section(".vectors"), used)) static const vectors table = {
    .stack = stack_top,
    .core = {reset, startup_halt, startup_halt, startup_halt, startup_halt, startup_halt, startup_halt, 0, 0,
             0, startup_halt, startup_halt, 0, startup_halt, startup_halt},
    .device = {[irq_uart0_receive] = on_uart_receive, [irq_timer1] = on_sample_timer}};
