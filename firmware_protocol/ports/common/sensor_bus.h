/// SPI to the MPU-9250, chip select by a GPIO.
#ifndef GYROLOG_PORT_SENSOR_BUS_H
#define GYROLOG_PORT_SENSOR_BUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

void sensor_bus_start(void);
/// False when the SPI makes no progress for a millisecond; it is then set up afresh.
bool sensor_bus_write(uint8_t address, uint8_t value);
bool sensor_bus_read(uint8_t address, uint8_t* bytes, size_t size);

#endif
