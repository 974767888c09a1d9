#include "sensor_bus.h"

#include <fsl_clock.h>
#include <fsl_reset.h>

#include "clocks.h"
#include "pins.h"
#include "sample_timer.h"

enum {
    READ = 0x80,
    // PS-MPU-9250A-01, electrical specifications, SPI: 1 MHz for all registers, 20 MHz for reading those of
    // sensor and interrupt. FIFO_R_W is not called one of the latter: it is read at 1 MHz.
    DIVIDER_1_MHz = CORE_HZ / 1000000U - 1U,
    DIVIDER_12_MHz = CORE_HZ / 12000000U - 1U,
    FIRST_FAST = 0x3A,  // INT_STATUS
    LAST_FAST = 0x48,   // GYRO_ZOUT_L
    FIFO_ENTRIES = 8,   // UM11126, Flexcomm SPI
    // PS-MPU-9250A-01, SPI timing: the chip select stays low for 500 ns behind the last clock.
    HOLD_TICKS = CORE_HZ / 2000000U + 1U,
    PATIENCE_TICKS = CORE_HZ / 1000U
};

// Eight bits; no chip select of the SPI's own.
#define FRAME                                                                     \
    (SPI_FIFOWR_LEN(7U) | SPI_FIFOWR_TXSSEL0_N_MASK | SPI_FIFOWR_TXSSEL1_N_MASK | \
     SPI_FIFOWR_TXSSEL2_N_MASK | SPI_FIFOWR_TXSSEL3_N_MASK)

void sensor_bus_start(void) {
    CLOCK_EnableClock(kCLOCK_Hs_Lspi);
    RESET_PeripheralReset(kHSLSPI_RST_SHIFT_RSTn);
    SPI8->FIFOCFG = SPI_FIFOCFG_ENABLETX_MASK | SPI_FIFOCFG_ENABLERX_MASK | SPI_FIFOCFG_EMPTYTX_MASK |
                    SPI_FIFOCFG_EMPTYRX_MASK;
    SPI8->DIV = DIVIDER_1_MHz;
    SPI8->CFG = SPI_CFG_MASTER_MASK | SPI_CFG_CPHA_MASK | SPI_CFG_CPOL_MASK | SPI_CFG_ENABLE_MASK;
}

// Sends `first`, then `size` bytes of `out` (zeros where it is NULL), and keeps what comes for them in `in`.
static bool exchange(uint8_t first, const uint8_t* out, uint8_t* in, size_t size) {
    size_t sent = 0;
    size_t received = 0;
    uint32_t progress = sample_timer_now();
    while (received < size + 1U) {
        const uint32_t status = SPI8->FIFOSTAT;
        bool idle = true;
        if ((sent < size + 1U) && (sent - received < FIFO_ENTRIES) &&
            ((status & SPI_FIFOSTAT_TXNOTFULL_MASK) != 0U)) {
            const uint8_t next = (sent == 0U) ? first : ((out != NULL) ? out[sent - 1U] : 0U);
            SPI8->FIFOWR = FRAME | next;
            ++sent;
            idle = false;
        }
        if ((status & SPI_FIFOSTAT_RXNOTEMPTY_MASK) != 0U) {
            const uint8_t byte = (uint8_t)SPI8->FIFORD;
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
    if (!done) { sensor_bus_start(); }
    return done;
}

bool sensor_bus_write(uint8_t address, uint8_t value) {
    SPI8->DIV = DIVIDER_1_MHz;
    return transfer(address, &value, NULL, 1);
}

bool sensor_bus_read(uint8_t address, uint8_t* bytes, size_t size) {
    const bool fast = (address >= FIRST_FAST) && (address + size <= LAST_FAST + 1U);
    SPI8->DIV = fast ? DIVIDER_12_MHz : DIVIDER_1_MHz;
    return transfer((uint8_t)(address | READ), NULL, bytes, size);
}
