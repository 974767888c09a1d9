// SSP1. Its own chip select would rise whenever the FIFO runs empty; the GPIO of pins.c takes its place.
#include "spi.h"

#include "port.h"
#include "registers.h"

// UM10360, chapter 18: the clock is PCLK / (CPSR * rate), CPSR even.
enum {
    PRESCALER = 2,
    RATE_SLOW = CORE_HZ / PRESCALER / 1000000U,   // 1 MHz
    RATE_FAST = CORE_HZ / PRESCALER / 12500000U,  // 12.5 MHz
};

#define MODE_3 (SSP_CR0_BITS(8U) | SSP_CR0_CPOL | SSP_CR0_CPHA)

void spi_start(void) {
    SSP1->CR1 = 0;
    SSP1->CPSR = PRESCALER;
    SSP1->CR0 = MODE_3 | SSP_CR0_RATE(RATE_SLOW);
    SSP1->CR1 = SSP_CR1_ENABLE;
    uint8_t stale;
    for (unsigned i = 0; i < SPI_FIFO_ENTRIES; ++i) { (void)spi_get(&stale); }
}

void spi_set_fast(bool fast) { SSP1->CR0 = MODE_3 | SSP_CR0_RATE(fast ? RATE_FAST : RATE_SLOW); }

bool spi_put(uint8_t byte) {
    if ((SSP1->SR & SSP_SR_TNF) == 0U) { return false; }
    SSP1->DR = byte;
    return true;
}

bool spi_get(uint8_t* byte) {
    if ((SSP1->SR & SSP_SR_RNE) == 0U) { return false; }
    *byte = (uint8_t)SSP1->DR;
    return true;
}
