#include "sample_timer.h"

#include "handlers.h"
#include "registers.h"

enum { PRIORITY_CAPTURE = 0 };  // above USB's

static void (*edge)(uint32_t ticks);

void sample_timer_start(void (*on_edge)(uint32_t ticks)) {
    edge = on_edge;
    TIMER2->TCR = TIMER_TCR_RESET;
    TIMER2->CTCR = 0;  // counts the peripheral clock
    TIMER2->PR = 0;
    TIMER2->MCR = 0;
    TIMER2->CCR = TIMER_CCR_CAP0_RISING | TIMER_CCR_CAP0_INTERRUPT;
    TIMER2->TCR = TIMER_TCR_ENABLE;
    NVIC_SetPriority(TIMER2_IRQn, PRIORITY_CAPTURE);
    NVIC_EnableIRQ(TIMER2_IRQn);
}

uint32_t sample_timer_now(void) { return TIMER2->TC; }

void sample_timer_wait(uint32_t ticks) {
    const uint32_t begin = sample_timer_now();
    while (sample_timer_now() - begin < ticks) {}
}

void on_data_ready_capture(void) {
    // Cleared first: an edge from here on raises the interrupt anew. Read back, so that the write has reached
    // the timer before the handler can return.
    TIMER2->IR = TIMER_IR_CR0;
    (void)TIMER2->IR;
    edge(TIMER2->CR[0]);
}
