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

static void begin_next_frame(glp_frame_ring* self) {
    uint8_t prefix[SIZE_BYTES];
    for (size_t i = 0; i < sizeof prefix; ++i) {
        prefix[i] = self->bytes[self->begin];
        advance(self, 1);
    }
    self->front_bytes = glp_load_u16(prefix);
}

void glp_frame_ring_feed(glp_frame_ring* self, const glp_hal* hal) {
    while (self->used > 0U) {
        if (self->front_bytes == 0U) { begin_next_frame(self); }
        const size_t to_edge = self->capacity - self->begin;
        const size_t offered = (self->front_bytes < to_edge) ? self->front_bytes : to_edge;
        const size_t accepted = hal->link_write(hal->context, self->bytes + self->begin, offered);
        advance(self, accepted);
        self->front_bytes -= accepted;
        self->flush_due = self->flush_due || (accepted > 0U);
        if (accepted < offered) { return; }
    }
    if (self->flush_due) {
        hal->link_flush(hal->context);
        self->flush_due = false;
    }
}
