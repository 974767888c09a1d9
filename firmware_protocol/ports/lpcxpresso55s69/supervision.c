#include "supervision.h"

#include <fsl_clock.h>
#include <fsl_power.h>
#include <fsl_reset.h>

#include "../../src/memory.h"

enum {
    FRO_1M_HZ = 1000000,
    WATCHDOG_PRESCALER = 4,  // UM11126, WWDT: a fixed one
    TIMEOUT_S = 2,
    RNG_WARM_UP = 32  // discarded: the first numbers of the generator are not yet independent
};

// UM11126, protected flash region: the factory's 128-bit number.
#define UUID ((const uint8_t*)0x0009FC70U)

void supervision_start_watchdog(void) {
    SYSCON->CLOCK_CTRL |= SYSCON_CLOCK_CTRL_FRO1MHZ_CLK_ENA_MASK;
    CLOCK_EnableClock(kCLOCK_Wwdt);
    CLOCK_SetClkDiv(kCLOCK_DivWdtClk, 1U, true);
    WWDT->TC = FRO_1M_HZ / WATCHDOG_PRESCALER * TIMEOUT_S;
    WWDT->MOD = WWDT_MOD_WDEN_MASK | WWDT_MOD_WDRESET_MASK;
    supervision_feed();
}

void supervision_feed(void) {
    // Another register access between the two words would be a fault of its own.
    const uint32_t masked = __get_PRIMASK();
    __disable_irq();
    WWDT->FEED = 0xAAU;
    WWDT->FEED = 0x55U;
    __set_PRIMASK(masked);
}

void supervision_read_uid(uint8_t uid[GLP_UID_BYTES]) { memcpy(uid, UUID, GLP_UID_BYTES); }

uint32_t supervision_boot_id(void) {
    // Off after a reset: without them every boot has the same numbers.
    POWER_DisablePD(kPDRUNCFG_PD_RNG);
    CLOCK_EnableClock(kCLOCK_Rng);
    RESET_PeripheralReset(kRNG_RST_SHIFT_RSTn);
    uint32_t number = 0;
    for (int i = 0; i < RNG_WARM_UP; ++i) { number = RNG->RANDOM_NUMBER; }
    return number;
}

glp_reset_cause supervision_reset_cause(void) {
    const uint32_t cause = PMC->AOREG1;
    if ((cause & PMC_AOREG1_WDTRESET_MASK) != 0U) { return glp_reset_watchdog; }
    if ((cause & PMC_AOREG1_POR_MASK) != 0U) { return glp_reset_power_on; }
    if ((cause & PMC_AOREG1_BODRESET_MASK) != 0U) { return glp_reset_brown_out; }
    if ((cause & (PMC_AOREG1_SYSTEMRESET_MASK | PMC_AOREG1_SWRRESET_MASK)) != 0U) {
        return glp_reset_software;
    }
    return ((cause & PMC_AOREG1_PADRESET_MASK) != 0U) ? glp_reset_pin : glp_reset_unknown;
}
