/// The clock tree: everything runs from the board's 16 MHz crystal, so that time stamps are the crystal's.
#ifndef GYROLOG_PORT_LPCXPRESSO55S69_CLOCKS_H
#define GYROLOG_PORT_LPCXPRESSO55S69_CLOCKS_H

#include <stdint.h>

#define CORE_HZ 96000000U

/// Core, timer and SPI at CORE_HZ, USB at 48 MHz. Returns only when the crystal runs: without it the watchdog
/// must already be on.
void clocks_start(void);

#endif
