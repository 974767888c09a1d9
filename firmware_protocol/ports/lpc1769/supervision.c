#include "supervision.h"

#include <gyrolog_protocol/crc.h>

#include "../../src/memory.h"
#include "registers.h"

enum {
    INTERNAL_RC_HZ = 4000000,
    WATCHDOG_PRESCALER = 4,  // UM10360, chapter 28: a fixed one
    TIMEOUT_S = 2,
    NOISE_WORDS = 1024
};

// Not cleared at the start: what the memory's cells fall into at power-on, of which a few in a hundred differ
// from one time to the next, and from then on the number of the last boot in the first word.
__attribute__((section(".noinit"))) static uint32_t power_on_noise[NOISE_WORDS];

void supervision_start_watchdog(void) {
    WATCHDOG->WDCLKSEL = WDCLKSEL_INTERNAL_RC;  // not the crystal that it watches
    WATCHDOG->WDTC = INTERNAL_RC_HZ / WATCHDOG_PRESCALER * TIMEOUT_S;
    WATCHDOG->WDMOD = WDMOD_WDEN | WDMOD_WDRESET;
    supervision_feed();
}

void supervision_feed(void) {
    // Another access to the watchdog between the two words would be a fault of its own.
    const uint32_t masked = __get_PRIMASK();
    __disable_irq();
    WATCHDOG->WDFEED = 0xAAU;
    WATCHDOG->WDFEED = 0x55U;
    __set_PRIMASK(masked);
}

// Before interrupts are enabled: the ROM's stack and the flash are its own meanwhile.
void supervision_read_uid(uint8_t uid[GLP_UID_BYTES]) {
    uint32_t command[5] = {IAP_READ_SERIAL_NUMBER};
    uint32_t result[5] = {IAP_SUCCESS};
    _Static_assert(sizeof result - sizeof result[0] == GLP_UID_BYTES, "a status, then four words");
    IAP(command, result);
    memcpy(uid, &result[1], GLP_UID_BYTES);
}

uint32_t supervision_boot_id(void) {
    power_on_noise[0] = glp_crc32((const uint8_t*)power_on_noise, sizeof power_on_noise);
    return power_on_noise[0];
}

// UM10360, 3.4: a power-on reset clears the other causes; else each stays until it is written.
glp_reset_cause supervision_reset_cause(void) {
    const uint32_t cause = SYSTEM->RSID;
    SYSTEM->RSID = RSID_POR | RSID_EXTR | RSID_WDTR | RSID_BODR;
    if ((cause & RSID_POR) != 0U) { return glp_reset_power_on; }
    if ((cause & RSID_WDTR) != 0U) { return glp_reset_watchdog; }
    if ((cause & RSID_BODR) != 0U) { return glp_reset_brown_out; }
    if ((cause & RSID_EXTR) != 0U) { return glp_reset_pin; }
    return glp_reset_software;  // the core's SYSRESETREQ, as a debugger raises it, leaves no trace
}
