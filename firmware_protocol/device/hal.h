/// What a port supplies: a clock, the sensor's bus, the USB endpoint. Everything else is in board.c.
#ifndef GYROLOG_PROTOCOL_DEVICE_HAL_H
#define GYROLOG_PROTOCOL_DEVICE_HAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct glp_hal {
    void* context;       ///< Handed back as the first argument of every call
    bool sensor_on_spi;  ///< The sensor's I2C interface is then switched off, as its register map asks
    /// Free-running timer. It may be as narrow as the identity's tick_bits says.
    uint64_t (*ticks)(void* context);
    /// Sensor registers by SPI or I2C; false on a bus error. A read of several bytes is one burst: the
    /// register address counts up, except at FIFO_R_W, where every byte comes out of the FIFO.
    bool (*sensor_write)(void* context, uint8_t address, uint8_t value);
    bool (*sensor_read)(void* context, uint8_t address, uint8_t* bytes, size_t size);
    void (*delay_ms)(void* context, uint32_t duration_ms);
    /// Gives bytes to the IN endpoint without waiting; returns how many were accepted (0 when it is full).
    size_t (*link_write)(void* context, const uint8_t* bytes, size_t size);
    /// Nothing follows for now: send what is pending as a short packet, or a zero-length packet when the last
    /// one was full.
    void (*link_flush)(void* context);
    /// Count of USB start-of-frame tokens. May be NULL when the port has none.
    uint32_t (*usb_frame_number)(void* context);
} glp_hal;

#endif
