/// The registers that the port uses, by AN385 and the Cortex-M System Design Kit (CMSDK).
#ifndef GYROLOG_PROTOCOL_PORTS_MPS2_AN385_REGISTERS_H
#define GYROLOG_PROTOCOL_PORTS_MPS2_AN385_REGISTERS_H

#include <stdint.h>

#define CORE_HZ 25000000U

typedef struct cmsdk_timer {
    volatile uint32_t ctrl;  // 1: on, 8: interrupt
    volatile uint32_t value;
    volatile uint32_t reload;
    volatile uint32_t intclear;
} cmsdk_timer;

typedef struct cmsdk_uart {
    volatile uint32_t data;
    volatile uint32_t state;  // 1: transmitter full, 2: receiver full
    volatile uint32_t ctrl;   // 1: transmitter on, 2: receiver on, 8: receiver's interrupt
    volatile uint32_t intclear;
    volatile uint32_t bauddiv;
} cmsdk_uart;

#define TIMER0 ((cmsdk_timer*)0x40000000U)  // counts down at CORE_HZ: the ticks
#define TIMER1 ((cmsdk_timer*)0x40001000U)  // the sensor's sample clock
#define UART0 ((cmsdk_uart*)0x40004000U)
#define NVIC_ISER ((volatile uint32_t*)0xE000E100U)
#define NVIC_ICPR ((volatile uint32_t*)0xE000E280U)

enum { irq_uart0_receive = 0, irq_timer1 = 9 };

static inline void interrupts_off(void) { __asm volatile("cpsid i" ::: "memory"); }
static inline void interrupts_on(void) { __asm volatile("cpsie i" ::: "memory"); }

#endif
