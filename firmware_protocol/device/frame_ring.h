/// Frames that wait for the IN endpoint.
///
/// Invariants:
///   - A frame is put whole or not at all, and leaves whole: once its first byte was given to the endpoint
///     the rest follows, whatever is dropped behind it.
///   - used never exceeds capacity.
#ifndef GYROLOG_PROTOCOL_DEVICE_FRAME_RING_H
#define GYROLOG_PROTOCOL_DEVICE_FRAME_RING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct glp_frame_ring {
    uint8_t* bytes;  ///< Each frame: its size as two bytes, then its wire bytes
    size_t capacity;
    size_t begin;
    size_t used;
    size_t high_water;
    size_t front_bytes;  ///< Not yet given of the frame whose sending has begun
    bool flush_due;      ///< The endpoint holds bytes that no flush has followed
} glp_frame_ring;

void glp_frame_ring_init(glp_frame_ring* self, uint8_t* bytes, size_t capacity);
/// False, and nothing put, unless at least `reserve` bytes stay free behind it.
bool glp_frame_ring_put(glp_frame_ring* self, const uint8_t* wire, size_t size, size_t reserve);
/// Drops every frame whose sending has not begun.
void glp_frame_ring_drop_waiting(glp_frame_ring* self);
/// Gives the endpoint what it takes. Flushes the endpoint when the ring runs empty.
void glp_frame_ring_feed(glp_frame_ring* self, const glp_hal* hal);

#ifdef __cplusplus
}
#endif

#endif
