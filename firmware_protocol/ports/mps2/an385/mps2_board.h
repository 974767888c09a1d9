/// A Cortex-M3 on the MPS2 board: ARM application note AN385.
#ifndef GYROLOG_PROTOCOL_PORTS_MPS2_AN385_H
#define GYROLOG_PROTOCOL_PORTS_MPS2_AN385_H

#define BOARD_NAME "mps2-an385"
#define LARGE_MEMORY_BASE 0x21000000U  // PSRAM, 16 MiB
#define TIMERS_HZ 25000000U
#define TIMER0_BASE 0x40000000U
#define TIMER1_BASE 0x40001000U
#define UART0_BASE 0x40004000U

enum { irq_uart0_receive = 0, irq_timer0 = 8, irq_timer1 = 9 };

#endif
