/// What each turn of the main loop took, in ticks, and what the host got: kept in RAM while it is measured,
/// then written to files of the computer that runs QEMU.
///
/// Invariant: what is in one account of a turn is in no other one. The turn's own work is its duration
/// without the four.
#ifndef GYROLOG_PORT_MPS2_LOAD_LOAD_LOG_H
#define GYROLOG_PORT_MPS2_LOAD_LOAD_LOG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// As it is written, in this order.
typedef struct load_turn {
    uint32_t end_ticks;
    uint32_t bus;        ///< While the sensor was selected; the core waits for the bus there
    uint32_t interrupt;  ///< The core's data-ready handler
    uint32_t apart;      ///< Models of what a board has in hardware: sensor, USB controller and host
    uint32_t samples;    ///< Data-ready interrupts so far
    uint32_t kept;       ///< Bytes that the host has got so far
} load_turn;

/// The accounts of the current turn.
extern load_turn load_now;

void load_begin(void);
void load_turn_ended(void);
/// The ticks since `begin` belong to a model. With interrupts off only, or in one.
void load_apart_since(uint32_t begin);
/// What the host got.
void load_keep(const uint8_t* bytes, size_t size);
/// Writes `turns.bin` and `stream.bin`, and ends QEMU.
_Noreturn void load_end(void);

#endif
