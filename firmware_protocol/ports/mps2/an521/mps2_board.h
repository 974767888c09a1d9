/// A Cortex-M33 on the MPS2 board: ARM application note AN521. Secure addresses: those of the peripherals'
/// list with bit 28 set.
#ifndef GYROLOG_PROTOCOL_PORTS_MPS2_AN521_H
#define GYROLOG_PROTOCOL_PORTS_MPS2_AN521_H

#define BOARD_NAME "mps2-an521"
#define LARGE_MEMORY_BASE 0x80000000U  // PSRAM, 16 MiB
#define TIMERS_HZ 20000000U
#define TIMER0_BASE 0x50000000U
#define TIMER1_BASE 0x50001000U
#define UART0_BASE 0x50200000U

enum { irq_timer0 = 3, irq_timer1 = 4, irq_uart0_receive = 32 };

#endif
