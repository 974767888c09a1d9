#include "frame_ring.h"

#include "../src/little_endian.h"
#include "../src/memory.h"

enum { SIZE_BYTES = 2 };

void glp_frame_ring_init(glp_frame_ring* self, uint8_t* bytes, size_t capacity) {
    *self = (glp_frame_ring){.bytes = bytes, .capacity = capacity};
}

static void append(glp_frame_ring* self, const uint8_t* bytes, size_t size) {
    size_t end = self->begin + self->used;
    if (end >= self->capacity) { end -= self->capacity; }
    const size_t to_edge = self->capacity - end;
    const size_t first = (size < to_edge) ? size : to_edge;
    memcpy(self->bytes + end, bytes, first);
    memcpy(self->bytes, bytes + first, size - first);
    self->used += size;
}

bool glp_frame_ring_put(glp_frame_ring* self, const uint8_t* wire, size_t size, size_t reserve) {
    if (SIZE_BYTES + size + reserve > self->capacity - self->used) { return false; }
    uint8_t prefix[SIZE_BYTES];
    glp_store_u16(prefix, (uint16_t)size);
    append(self, prefix, sizeof prefix);
    append(self, wire, size);
    if (self->used > self->high_water) { self->high_water = self->used; }
    return true;
}

void glp_frame_ring_drop_waiting(glp_frame_ring* self) { self->used = self->front_bytes; }

static void advance(glp_frame_ring* self, size_t size) {
    self->begin += size;
    if (self->begin >= self->capacity) { self->begin -= self->capacity; }
    self->used -= size;
}

static size_t front_size(const glp_frame_ring* self) {
    const size_t second = (self->begin + 1U < self->capacity) ? self->begin + 1U : 0U;
    const uint8_t prefix[SIZE_BYTES] = {self->bytes[self->begin], self->bytes[second]};
    return glp_load_u16(prefix);
}

// True when the endpoint took all that was offered.
static bool give(glp_frame_ring* self, const glp_hal* hal) {
    const size_t prefix_bytes = (self->front_bytes == 0U) ? SIZE_BYTES : 0U;
    const size_t left = (self->front_bytes == 0U) ? front_size(self) : self->front_bytes;
    size_t at = self->begin + prefix_bytes;
    if (at >= self->capacity) { at -= self->capacity; }
    const size_t to_edge = self->capacity - at;
    const size_t offered = (left < to_edge) ? left : to_edge;
    const size_t accepted = hal->link_write(hal->context, self->bytes + at, offered);
    // A frame has begun only with its first byte: one that was merely offered may still be dropped.
    if (accepted == 0U) { return false; }
    advance(self, prefix_bytes + accepted);
    self->front_bytes = left - accepted;
    self->flush_due = true;
    return accepted == offered;
}

void glp_frame_ring_feed(glp_frame_ring* self, const glp_hal* hal) {
    while (self->used > 0U) {
        if (!give(self, hal)) { return; }
    }
    if (self->flush_due) {
        hal->link_flush(hal->context);
        self->flush_due = false;
    }
}
