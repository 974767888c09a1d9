/// What a port supplies: a clock, the sensor's bus, the USB endpoint. Everything else is in board.c.
#ifndef GYROLOG_PROTOCOL_DEVICE_HAL_H
#define GYROLOG_PROTOCOL_DEVICE_HAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct glp_hal {
    void* context;  ///< Handed back as the first argument of every call
    /// Free-running timer. It may be as narrow as the identity's tick_bits says.
    uint64_t (*ticks)(void* context);
    /// Sensor registers by SPI or I2C; false on a bus error. A read of several bytes is one burst.
    bool (*sensor_write)(void* context, uint8_t address, uint8_t value);
    bool (*sensor_read)(void* context, uint8_t address, uint8_t* bytes, size_t size);
    void (*delay_ms)(void* context, uint32_t duration_ms);
    /// Gives bytes to the IN endpoint without waiting; returns how many were accepted (0 when it is full).
    size_t (*link_write)(void* context, const uint8_t* bytes, size_t size);
    /// Nothing follows for now: send what is pending as a short packet, or a zero-length packet when the last one was
    /// full.
    void (*link_flush)(void* context);
    /// Count of USB start-of-frame tokens, or 0 when the port has none.
    uint32_t (*usb_frame_number)(void* context);
} glp_hal;

#endif
