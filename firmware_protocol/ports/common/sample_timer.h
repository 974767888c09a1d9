/// The timer that time stamps are taken from: 32 bits at CORE_HZ, captured by the data-ready line itself, so
/// that no interrupt latency enters a stamp.
#ifndef GYROLOG_PORT_SAMPLE_TIMER_H
#define GYROLOG_PORT_SAMPLE_TIMER_H

#include <stdint.h>

/// `on_edge` runs in the interrupt, with the tick of the line's rising edge. Two edges before the interrupt
/// is served are one call: the core finds the missing instant by the FIFO's level.
void sample_timer_start(void (*on_edge)(uint32_t ticks));
uint32_t sample_timer_now(void);
void sample_timer_wait(uint32_t ticks);

#endif
