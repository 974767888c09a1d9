#include "clocks.h"

#include "registers.h"

// UM10360, 4.5: the 12 MHz crystal gives Fcco = 2 M F / N = 2 * 50 * 12 MHz / 3 = 400 MHz, within 275 to 550
// MHz.
#define PLL0_M 50U
#define PLL0_N 3U
#define CORE_DIVIDER 4U
_Static_assert(2U * PLL0_M * 12000000U / PLL0_N / CORE_DIVIDER == CORE_HZ, "PLL0");
// UM10360, 4.6: USB takes M F = 4 * 12 MHz = 48 MHz; Fcco = 48 MHz * 2 P = 192 MHz with P = 2, within 156 to
// 320 MHz.
#define PLL1_M 4U
_Static_assert(PLL1_M * 12000000U == 48000000U, "PLL1");

// UM10360, 5.4: five clocks suit every core clock of this part.
#define FLASH_CLOCKS 5U

// No interrupt is enabled yet that could come between the two words.
static void feed_pll0(void) {
    SYSTEM->PLL0FEED = PLLFEED_FIRST;
    SYSTEM->PLL0FEED = PLLFEED_SECOND;
}

static void feed_pll1(void) {
    SYSTEM->PLL1FEED = PLLFEED_FIRST;
    SYSTEM->PLL1FEED = PLLFEED_SECOND;
}

static void start_pll0(void) {
    // A debugger may have left it running. First off the core, then off.
    SYSTEM->PLL0CON &= ~PLLCON_CONNECT;
    feed_pll0();
    SYSTEM->PLL0CON = 0;
    feed_pll0();
    SYSTEM->CLKSRCSEL = CLKSRCSEL_MAIN_OSCILLATOR;
    SYSTEM->PLL0CFG = PLL0CFG_M(PLL0_M) | PLL0CFG_N(PLL0_N);
    feed_pll0();
    SYSTEM->PLL0CON = PLLCON_ENABLE;
    feed_pll0();
    SYSTEM->CCLKCFG = CCLKCFG_DIVIDE(CORE_DIVIDER);
    while ((SYSTEM->PLL0STAT & PLL0STAT_LOCKED) == 0U) {}
    SYSTEM->PLL0CON = PLLCON_ENABLE | PLLCON_CONNECT;
    feed_pll0();
    while ((SYSTEM->PLL0STAT & PLL0STAT_CONNECTED) == 0U) {}
}

static void start_pll1(void) {
    SYSTEM->PLL1CON = 0;
    feed_pll1();
    SYSTEM->PLL1CFG = PLL1CFG_M(PLL1_M) | PLL1CFG_P_IS_2;
    feed_pll1();
    SYSTEM->PLL1CON = PLLCON_ENABLE;
    feed_pll1();
    while ((SYSTEM->PLL1STAT & PLL1STAT_LOCKED) == 0U) {}
    SYSTEM->PLL1CON = PLLCON_ENABLE | PLLCON_CONNECT;
    feed_pll1();
    while ((SYSTEM->PLL1STAT & PLL1STAT_CONNECTED) == 0U) {}
}

void clocks_start(void) {
    // Before PLL0: errata sheet ES_LPC176x, PCLKSELx, a write behind its connection may be lost.
    SYSTEM->PCLKSEL0 = PCLKSEL0_SSP1_IS_CCLK;
    SYSTEM->PCLKSEL1 = PCLKSEL1_TIMER2_IS_CCLK;
    SYSTEM->PCONP |= PCONP_SSP1 | PCONP_TIM2 | PCONP_USB;
    // The flash must suit the faster clock before it is chosen.
    SYSTEM->FLASHCFG = (SYSTEM->FLASHCFG & ~FLASHCFG_FLASHTIM_MASK) | FLASHCFG_FLASHTIM(FLASH_CLOCKS);
    SYSTEM->SCS = SCS_OSCEN;  // OSCRANGE 0: 1 to 20 MHz
    while ((SYSTEM->SCS & SCS_OSCSTAT) == 0U) {}
    start_pll0();
    start_pll1();
}
