/// An MPU-9250 as far as device/mpu9250.c uses one: registers, FIFO, data-ready interrupt, a slow triangle on
/// each axis. A timer's interrupt is its sample clock.
#ifndef GYROLOG_PROTOCOL_PORTS_MPS2_SYNTHETIC_SENSOR_H
#define GYROLOG_PROTOCOL_PORTS_MPS2_SYNTHETIC_SENSOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

void synthetic_sensor_reset(void);
/// Each is one bus transaction, which no sample interrupts.
void synthetic_sensor_write(uint8_t address, uint8_t value);
void synthetic_sensor_read(uint8_t address, uint8_t* bytes, size_t size);
/// Takes one sample. True when the interrupt pin pulses.
bool synthetic_sensor_sample(void);
/// Between two of its samples, in ticks of a timer; 0 while nothing wants any.
uint32_t synthetic_sensor_period(uint32_t timer_hz);

#endif
