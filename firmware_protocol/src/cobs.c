#include <gyrolog_protocol/cobs.h>

#include "cobs_encoder.h"
#include "memory.h"

#define FULL_CODE 0xFFU  // 254 bytes and no zero behind them

static bool open_group(glp_cobs_encoder* self) {
    if (self->size == self->capacity) { return false; }
    self->code_at = self->size++;
    self->code = 1U;
    self->open = true;
    return true;
}

bool glp_cobs_begin(glp_cobs_encoder* self, uint8_t* out, size_t capacity) {
    self->out = out;
    self->capacity = capacity;
    self->size = 0;
    return open_group(self);
}

bool glp_cobs_put(glp_cobs_encoder* self, const uint8_t* bytes, size_t size) {
    for (size_t i = 0; i < size; ++i) {
        if (!self->open && !open_group(self)) { return false; }
        if (bytes[i] == 0U) {
            self->out[self->code_at] = self->code;
            if (!open_group(self)) { return false; }
            continue;
        }
        if (self->size == self->capacity) { return false; }
        self->out[self->size++] = bytes[i];
        if (++self->code == FULL_CODE) {
            self->out[self->code_at] = FULL_CODE;
            self->open = false;
        }
    }
    return true;
}

void glp_cobs_end(glp_cobs_encoder* self) {
    if (self->open) { self->out[self->code_at] = self->code; }
    self->open = false;
}

glp_cobs_result glp_cobs_encode(const uint8_t* in, size_t size, uint8_t* out, size_t capacity) {
    glp_cobs_encoder encoder;
    if (!glp_cobs_begin(&encoder, out, capacity) || !glp_cobs_put(&encoder, in, size)) {
        return (glp_cobs_result){glp_status_no_space, 0};
    }
    glp_cobs_end(&encoder);
    return (glp_cobs_result){glp_status_ok, encoder.size};
}

// Copies up to 254 bytes towards lower addresses of the same buffer, or between buffers. False at a zero
// byte.
static bool copy_group(uint8_t* out, const uint8_t* in, size_t size) {
#if __STDC_HOSTED__
    // Sensor counts hold a zero every few bytes: a call costs more than the bytes it moves.
    if (size >= 16U) {
        if (memchr(in, 0, size) != NULL) { return false; }
        memmove(out, in, size);
        return true;
    }
#endif
    for (size_t i = 0; i < size; ++i) {
        if (in[i] == 0U) { return false; }
        out[i] = in[i];
    }
    return true;
}

glp_cobs_result glp_cobs_decode(const uint8_t* in, size_t size, uint8_t* out, size_t capacity) {
    const glp_cobs_result refused = {glp_status_bad_cobs, 0};
    if (size == 0U) { return refused; }
    size_t written = 0;
    bool after_full_group = false;
    for (size_t at = 0; at < size;) {
        const uint8_t code = in[at++];
        const size_t group = (size_t)code - 1U;
        if ((code == 0U) || (group > size - at)) { return refused; }
        // An empty group at the very end says "no zero here". Behind a full group that was said already.
        if (after_full_group && (group == 0U) && (at == size)) { return refused; }
        if (group > capacity - written) { return (glp_cobs_result){glp_status_no_space, 0}; }
        if (!copy_group(out + written, in + at, group)) { return refused; }
        at += group;
        written += group;
        after_full_group = (code == FULL_CODE);
        if (!after_full_group && (at < size)) {
            if (written == capacity) { return (glp_cobs_result){glp_status_no_space, 0}; }
            out[written++] = 0U;
        }
    }
    return (glp_cobs_result){glp_status_ok, written};
}
