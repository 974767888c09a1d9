/// The registers that the port uses, by the Cortex-M System Design Kit (CMSDK); where they are is the
/// board's.
#ifndef GYROLOG_PROTOCOL_PORTS_MPS2_REGISTERS_H
#define GYROLOG_PROTOCOL_PORTS_MPS2_REGISTERS_H

#include <mps2_board.h>
#include <stdint.h>

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

#define TIMER0 ((cmsdk_timer*)TIMER0_BASE)  // counts down at TIMERS_HZ: the ticks
#define TIMER1 ((cmsdk_timer*)TIMER1_BASE)  // the sensor's sample clock
#define UART0 ((cmsdk_uart*)UART0_BASE)
#define NVIC_ISER ((volatile uint32_t*)0xE000E100U)
#define NVIC_ICPR ((volatile uint32_t*)0xE000E280U)

static inline void interrupt_enable(unsigned irq) { NVIC_ISER[irq / 32U] = 1U << (irq % 32U); }
static inline void interrupt_forget(unsigned irq) { NVIC_ICPR[irq / 32U] = 1U << (irq % 32U); }
static inline void interrupts_off(void) { __asm volatile("cpsid i" ::: "memory"); }
static inline void interrupts_on(void) { __asm volatile("cpsie i" ::: "memory"); }

#endif
