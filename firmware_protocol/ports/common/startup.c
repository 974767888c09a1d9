#include "startup.h"

#include <stddef.h>
#include <stdint.h>

#include "../../src/memory.h"

extern uint8_t data_begin[];
extern uint8_t data_end[];
extern const uint8_t data_load[];
extern uint8_t bss_begin[];
extern uint8_t bss_end[];

void startup_fill_memory(void) {
    memcpy(data_begin, data_load, (size_t)(data_end - data_begin));
    memset(bss_begin, 0, (size_t)(bss_end - bss_begin));
}

void startup_halt(void) {
    __asm__ volatile("cpsid i" ::: "memory");
    for (;;) {}
}
