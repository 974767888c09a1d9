/// The SPI that the sensor is at, in mode 3, eight bits a frame. SPI_FIFO_ENTRIES of port.h bytes may be
/// under way: no more have to be put than have been got back.
#ifndef GYROLOG_PORT_SPI_H
#define GYROLOG_PORT_SPI_H

#include <stdbool.h>
#include <stdint.h>

/// Also drops what the FIFOs hold. The clock is then the slow one.
void spi_start(void);
/// 1 MHz, or fast: at most 20 MHz. Between transfers only.
void spi_set_fast(bool fast);
/// Neither waits: false when there is no room, or nothing yet.
bool spi_put(uint8_t byte);
bool spi_get(uint8_t* byte);

#endif
