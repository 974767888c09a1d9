// The high-speed SPI, Flexcomm 8.
#include "spi.h"

#include <fsl_clock.h>
#include <fsl_reset.h>

#include "port.h"

enum {
    FUNCTION_SPI = 2,  // UM11126, Flexcomm PSELID; a reset leaves the interface without a function
    DIVIDER_SLOW = CORE_HZ / 1000000U - 1U,
    DIVIDER_FAST = CORE_HZ / 12000000U - 1U,
};

// Eight bits; no chip select of the SPI's own.
#define FRAME                                                                     \
    (SPI_FIFOWR_LEN(7U) | SPI_FIFOWR_TXSSEL0_N_MASK | SPI_FIFOWR_TXSSEL1_N_MASK | \
     SPI_FIFOWR_TXSSEL2_N_MASK | SPI_FIFOWR_TXSSEL3_N_MASK)

void spi_start(void) {
    CLOCK_EnableClock(kCLOCK_Hs_Lspi);
    RESET_PeripheralReset(kHSLSPI_RST_SHIFT_RSTn);
    FLEXCOMM8->PSELID = FLEXCOMM_PSELID_PERSEL(FUNCTION_SPI);
    SPI8->FIFOCFG = SPI_FIFOCFG_ENABLETX_MASK | SPI_FIFOCFG_ENABLERX_MASK | SPI_FIFOCFG_EMPTYTX_MASK |
                    SPI_FIFOCFG_EMPTYRX_MASK;
    SPI8->DIV = DIVIDER_SLOW;
    SPI8->CFG = SPI_CFG_MASTER_MASK | SPI_CFG_CPHA_MASK | SPI_CFG_CPOL_MASK | SPI_CFG_ENABLE_MASK;
}

void spi_set_fast(bool fast) { SPI8->DIV = fast ? DIVIDER_FAST : DIVIDER_SLOW; }

bool spi_put(uint8_t byte) {
    if ((SPI8->FIFOSTAT & SPI_FIFOSTAT_TXNOTFULL_MASK) == 0U) { return false; }
    SPI8->FIFOWR = FRAME | byte;
    return true;
}

bool spi_get(uint8_t* byte) {
    if ((SPI8->FIFOSTAT & SPI_FIFOSTAT_RXNOTEMPTY_MASK) == 0U) { return false; }
    *byte = (uint8_t)SPI8->FIFORD;
    return true;
}
