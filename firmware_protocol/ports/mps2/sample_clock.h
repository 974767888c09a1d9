/// The timer whose interrupt is the synthetic sensor's sample clock.
#ifndef GYROLOG_PROTOCOL_PORTS_MPS2_SAMPLE_CLOCK_H
#define GYROLOG_PROTOCOL_PORTS_MPS2_SAMPLE_CLOCK_H

#include <stdint.h>

void sample_clock_start(void);
/// Runs it as the sensor's registers ask, at so many ticks a second. After each write to the sensor,
/// interrupts off.
void sample_clock_follow_sensor(uint32_t timer_hz);

#endif
