#include "sample_clock.h"

#include "registers.h"
#include "synthetic_sensor.h"

void sample_clock_start(void) { interrupt_enable(irq_timer1); }

void sample_clock_follow_sensor(uint32_t timer_hz) {
    static uint32_t period;
    const uint32_t wanted = synthetic_sensor_period(timer_hz);
    if (wanted == period) { return; }
    period = wanted;
    TIMER1->ctrl = 0;
    TIMER1->intclear = 1U;
    interrupt_forget(irq_timer1);
    if (period == 0U) { return; }
    TIMER1->reload = period - 1U;
    TIMER1->value = period - 1U;
    TIMER1->ctrl = 1U | 8U;
}
