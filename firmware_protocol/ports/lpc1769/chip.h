/// The name by which TinyUSB's driver asks for the part's registers.
#ifndef GYROLOG_PORT_LPC1769_CHIP_H
#define GYROLOG_PORT_LPC1769_CHIP_H

#include "registers.h"

#endif
