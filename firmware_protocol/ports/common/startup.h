/// Between reset and run(): memory as C expects it.
#ifndef GYROLOG_PORT_STARTUP_H
#define GYROLOG_PORT_STARTUP_H

/// Copies .data and clears .bss, by the names of the port's linker script.
void startup_fill_memory(void);
/// Of faults and of interrupts that nobody uses. Nothing feeds the watchdog there: the part resets, and HELLO
/// tells why.
void startup_halt(void);

#endif
