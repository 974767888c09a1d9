/// The clock tree: everything runs from the board's crystal, so that time stamps are the crystal's.
#ifndef GYROLOG_PORT_CLOCKS_H
#define GYROLOG_PORT_CLOCKS_H

#include "port.h"

/// Core, timer and SPI at CORE_HZ, USB at 48 MHz. Returns only when the crystal runs: without it the watchdog
/// must already be on.
void clocks_start(void);

#endif
