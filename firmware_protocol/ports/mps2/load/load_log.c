#include "load_log.h"

#include "../../../src/memory.h"
#include "../registers.h"
#include "sample_timer.h"

enum {
    STREAM_BYTES = 1024 * 1024,
    TURNS_MAX = 500000,
    // "Semihosting for AArch32 and AArch64", Arm: operations and the mode "wb".
    SYS_OPEN = 0x01,
    SYS_CLOSE = 0x02,
    SYS_WRITE = 0x05,
    SYS_EXIT = 0x18,
    MODE_WB = 5,
    STOPPED_APPLICATION_EXIT = 0x20026,
    STOPPED_ERROR = 0x20023
};

// The board's large memory, which the linker script leaves alone.
static uint8_t* const stream = (uint8_t*)LARGE_MEMORY_BASE;
static load_turn* const turns = (load_turn*)(LARGE_MEMORY_BASE + STREAM_BYTES);
static uint32_t turn_count;
static bool measuring;

load_turn load_now;

static uintptr_t semihost(uintptr_t operation, uintptr_t argument) {
    register uintptr_t r0 __asm("r0") = operation;
    register uintptr_t r1 __asm("r1") = argument;
    __asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

_Noreturn static void stop(uintptr_t reason) {
    for (;;) { semihost(SYS_EXIT, reason); }
}

static void write_file(const char* name, size_t name_bytes, const void* bytes, size_t size) {
    const uintptr_t open[] = {(uintptr_t)name, MODE_WB, name_bytes};
    const uintptr_t file = semihost(SYS_OPEN, (uintptr_t)open);
    const uintptr_t write[] = {file, (uintptr_t)bytes, size};
    if ((file == UINTPTR_MAX) || (semihost(SYS_WRITE, (uintptr_t)write) != 0U)) { stop(STOPPED_ERROR); }
    semihost(SYS_CLOSE, (uintptr_t)&file);
}

void load_begin(void) { measuring = true; }

void load_apart_since(uint32_t begin) { load_now.apart += sample_timer_now() - begin; }

void load_turn_ended(void) {
    interrupts_off();
    load_now.end_ticks = sample_timer_now();
    if (measuring && (turn_count < TURNS_MAX)) { turns[turn_count++] = load_now; }
    load_now.bus = load_now.interrupt = load_now.apart = 0;
    interrupts_on();
}

void load_keep(const uint8_t* bytes, size_t size) {
    if (size > STREAM_BYTES - load_now.kept) { stop(STOPPED_ERROR); }
    memcpy(stream + load_now.kept, bytes, size);
    load_now.kept += size;
}

_Noreturn void load_end(void) {
    static const char turns_name[] = "turns.bin";
    static const char stream_name[] = "stream.bin";
    write_file(turns_name, sizeof turns_name - 1U, turns, turn_count * sizeof(load_turn));
    write_file(stream_name, sizeof stream_name - 1U, stream, load_now.kept);
    stop((turn_count < TURNS_MAX) ? STOPPED_APPLICATION_EXIT : STOPPED_ERROR);
}
