#include "clocks.h"

#include <fsl_clock.h>
#include <fsl_power.h>

enum { CRYSTAL_HZ = 16000000 };

void clocks_start(void) {
    // Flash and core voltage first: both must suit the faster clock before it is chosen.
    POWER_SetVoltageForFreq(CORE_HZ);
    CLOCK_SetFLASHAccessCyclesForFreq(CORE_HZ);

    CLOCK_SetupExtClocking(CRYSTAL_HZ);
    ANACTRL->XO32M_CTRL |= ANACTRL_XO32M_CTRL_ENABLE_SYSTEM_CLK_OUT_MASK;
    CLOCK_AttachClk(kEXT_CLK_to_PLL1);
    // UM11126, PLL1: Fcco = 16 MHz / N * M = 16 MHz / 4 * 96 = 384 MHz, within 275 to 550 MHz; the output is
    // Fcco / (2 P) = 96 MHz with P = 2. Bandwidth for M = 96: SELI = 2 * (M / 4) + 3 = 51, SELP = M / 4 + 1
    // = 25.
    const pll_setup_t setup = {
        .pllctrl = SYSCON_PLL1CTRL_CLKEN_MASK | SYSCON_PLL1CTRL_SELI(51U) | SYSCON_PLL1CTRL_SELP(25U),
        .pllndec = SYSCON_PLL1NDEC_NDIV(4U),
        .pllpdec = SYSCON_PLL1PDEC_PDIV(2U),
        .pllmdec = SYSCON_PLL1MDEC_MDIV(96U),
        .pllRate = CORE_HZ,
        .flags = PLL_SETUPFLAG_WAITLOCK};
    CLOCK_SetPLL1Freq(&setup);
    while (!CLOCK_IsPLL1Locked()) {}  // the call before gives up after 600 us, and does not say so

    CLOCK_SetClkDiv(kCLOCK_DivAhbClk, 1U, false);
    CLOCK_AttachClk(kPLL1_to_MAIN_CLK);
    CLOCK_AttachClk(kMAIN_CLK_to_CTIMER0);
    CLOCK_AttachClk(kMAIN_CLK_to_HSLSPI);
    CLOCK_SetClkDiv(kCLOCK_DivUsb0Clk, 2U, false);
    CLOCK_AttachClk(kPLL1_to_USB0_CLK);
}
