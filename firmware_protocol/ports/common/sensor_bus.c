#include "sensor_bus.h"

#include "pins.h"
#include "port.h"
#include "sample_timer.h"
#include "spi.h"

enum {
    READ = 0x80,
    // PS-MPU-9250A-01, electrical specifications, SPI: 1 MHz for all registers, 20 MHz for reading those of
    // sensor and interrupt. FIFO_R_W is not called one of the latter: it is read at 1 MHz.
    FIRST_FAST = 0x3A,  // INT_STATUS
    LAST_FAST = 0x48,   // GYRO_ZOUT_L
    // PS-MPU-9250A-01, SPI timing: the chip select stays low for 500 ns behind the last clock.
    HOLD_TICKS = CORE_HZ / 2000000U + 1U,
    PATIENCE_TICKS = CORE_HZ / 1000U
};

void sensor_bus_start(void) { spi_start(); }

// Sends `first`, then `size` bytes of `out` (zeros where it is NULL), and keeps what comes for them in `in`.
static bool exchange(uint8_t first, const uint8_t* out, uint8_t* in, size_t size) {
    size_t sent = 0;
    size_t received = 0;
    uint32_t progress = sample_timer_now();
    while (received < size + 1U) {
        bool idle = true;
        if ((sent < size + 1U) && (sent - received < SPI_FIFO_ENTRIES)) {
            const uint8_t next = (sent == 0U) ? first : ((out != NULL) ? out[sent - 1U] : 0U);
            if (spi_put(next)) {
                ++sent;
                idle = false;
            }
        }
        uint8_t byte = 0;
        if (spi_get(&byte)) {
            if ((received > 0U) && (in != NULL)) { in[received - 1U] = byte; }
            ++received;
            idle = false;
        }
        if (!idle) {
            progress = sample_timer_now();
        } else if (sample_timer_now() - progress > PATIENCE_TICKS) {
            return false;
        }
    }
    return true;
}

static bool transfer(uint8_t first, const uint8_t* out, uint8_t* in, size_t size) {
    pins_select_sensor(true);
    const bool done = exchange(first, out, in, size);
    sample_timer_wait(HOLD_TICKS);
    pins_select_sensor(false);
    if (!done) { spi_start(); }
    return done;
}

bool sensor_bus_write(uint8_t address, uint8_t value) {
    spi_set_fast(false);
    return transfer(address, &value, NULL, 1);
}

bool sensor_bus_read(uint8_t address, uint8_t* bytes, size_t size) {
    spi_set_fast((address >= FIRST_FAST) && (address + size <= LAST_FAST + 1U));
    return transfer((uint8_t)(address | READ), NULL, bytes, size);
}
