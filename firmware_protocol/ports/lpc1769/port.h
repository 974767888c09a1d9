/// What the shared code of ports/common is told about this port.
#ifndef GYROLOG_PORT_LPC1769_PORT_H
#define GYROLOG_PORT_LPC1769_PORT_H

#define PORT_BOARD "LPCXpresso1769"      ///< In the product string
#define PORT_FIRMWARE "gyrolog lpc1769"  ///< In HELLO
#define CORE_HZ 100000000U               ///< Core, timer and the SSP's input
#define SPI_FIFO_ENTRIES 8U              ///< UM10360, chapter 18: frames in each of the SSP's FIFOs
/// The frames' ring lies in the second memory, so that stack and data have the first to themselves.
#define PORT_RING_SECTION __attribute__((section(".bss.ahb.ring")))

#endif
