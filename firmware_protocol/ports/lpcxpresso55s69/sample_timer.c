#include "sample_timer.h"

#include <fsl_clock.h>
#include <fsl_reset.h>

#include "handlers.h"

enum {
    CAPTURE_INPUT = 16,    // CT_INP16
    PRIORITY_CAPTURE = 0,  // above USB's
};

static void (*edge)(uint32_t ticks);

void sample_timer_start(void (*on_edge)(uint32_t ticks)) {
    edge = on_edge;
    CLOCK_EnableClock(kCLOCK_InputMux);
    INPUTMUX->TIMER0CAPTSEL[0] = CAPTURE_INPUT;
    CLOCK_EnableClock(kCLOCK_Timer0);
    RESET_PeripheralReset(kCTIMER0_RST_SHIFT_RSTn);
    CTIMER0->PR = 0;
    CTIMER0->CCR = CTIMER_CCR_CAP0RE_MASK | CTIMER_CCR_CAP0I_MASK;
    CTIMER0->TCR = CTIMER_TCR_CEN_MASK;
    NVIC_SetPriority(CTIMER0_IRQn, PRIORITY_CAPTURE);
    NVIC_EnableIRQ(CTIMER0_IRQn);
}

uint32_t sample_timer_now(void) { return CTIMER0->TC; }

void sample_timer_wait(uint32_t ticks) {
    const uint32_t begin = sample_timer_now();
    while (sample_timer_now() - begin < ticks) {}
}

void on_data_ready_capture(void) {
    // Cleared first: an edge from here on raises the interrupt anew. Read back, so that the write has reached
    // the timer before the handler can return.
    CTIMER0->IR = CTIMER_IR_CR0INT_MASK;
    (void)CTIMER0->IR;
    edge(CTIMER0->CR[0]);
}
