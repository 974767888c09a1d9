/// What the shared code of ports/common is told when it runs on an MPS2 board in QEMU to be measured.
///
/// QEMU counts an instruction as INSTRUCTION_NS of virtual time. The board is to believe that its core
/// executes INSTRUCTIONS_PER_S, so all durations are stretched alike: a second of the board's is CORE_HZ
/// ticks of the timer. A tick is less than an instruction, so that the count is exact.
#ifndef GYROLOG_PORT_MPS2_LOAD_PORT_H
#define GYROLOG_PORT_MPS2_LOAD_PORT_H

#include <mps2_board.h>

#define PORT_BOARD BOARD_NAME
#define PORT_FIRMWARE "gyrolog " BOARD_NAME " load"
/// Of the timer; ports/common calls it the core's.
#define CORE_HZ ((uint32_t)((uint64_t)INSTRUCTIONS_PER_S * INSTRUCTION_NS * (TIMERS_HZ / 1000U) / 1000000U))
#define SPI_FIFO_ENTRIES 8U
#define PORT_RING_SECTION

#endif
