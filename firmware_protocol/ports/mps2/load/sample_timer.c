// Timer 0 is the clock; timer 1, the sensor's own, stands for the data-ready line.
#include "sample_timer.h"

#include "../registers.h"
#include "../synthetic_sensor.h"
#include "handlers.h"
#include "load_log.h"
#include "sensor_model.h"

static void (*edge)(uint32_t ticks);

void sample_timer_start(void (*on_edge)(uint32_t ticks)) {
    edge = on_edge;
    TIMER0->reload = UINT32_MAX;
    TIMER0->value = UINT32_MAX;
    TIMER0->ctrl = 1U;
    sensor_model_start();
}

uint32_t sample_timer_now(void) { return UINT32_MAX - TIMER0->value; }

void sample_timer_wait(uint32_t ticks) {
    const uint32_t begin = sample_timer_now();
    while (sample_timer_now() - begin < ticks) {}
}

void on_data_ready_capture(void) {
    const uint32_t now = sample_timer_now();
    const uint32_t edge_ticks =
        now - (TIMER1->reload - TIMER1->value);  // as a capture register would hold it
    const bool pulse = synthetic_sensor_sample();
    TIMER1->intclear = 1U;
    load_apart_since(now);
    if (!pulse) { return; }
    const uint32_t begin = sample_timer_now();
    edge(edge_ticks);
    load_now.interrupt += sample_timer_now() - begin;
    ++load_now.samples;
}
