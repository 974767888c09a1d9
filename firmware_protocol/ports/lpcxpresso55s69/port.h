/// What the shared code of ports/common is told about this port.
#ifndef GYROLOG_PORT_LPCXPRESSO55S69_PORT_H
#define GYROLOG_PORT_LPCXPRESSO55S69_PORT_H

#define PORT_BOARD "LPC55S69-EVK"         ///< In the product string
#define PORT_FIRMWARE "gyrolog lpc55s69"  ///< In HELLO
#define CORE_HZ 96000000U                 ///< Core, timer and SPI
#define SPI_FIFO_ENTRIES 8U               ///< UM11126, Flexcomm SPI
#define PORT_RING_SECTION                 ///< The frames' ring lies with everything else

#endif
