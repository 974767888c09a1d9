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
    // A byte written may lie anywhere, so the compiler would load every field again after each: hence the
    // copy.
    glp_cobs_encoder local = *self;
    bool fits = true;
    for (size_t i = 0; (i < size) && fits; ++i) {
        if (!local.open) { fits = open_group(&local); }
        if (!fits) { break; }
        if (bytes[i] == 0U) {
            local.out[local.code_at] = local.code;
            fits = open_group(&local);
        } else if (local.size == local.capacity) {
            fits = false;
        } else {
            local.out[local.size++] = bytes[i];
            if (++local.code == FULL_CODE) {
                local.out[local.code_at] = FULL_CODE;
                local.open = false;
            }
        }
    }
    *self = local;
    return fits;
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

static bool has_zero(const uint8_t* bytes, size_t size) {
#if __STDC_HOSTED__
    return memchr(bytes, 0, size) != NULL;
#else
    for (size_t i = 0; i < size; ++i) {
        if (bytes[i] == 0U) { return true; }
    }
    return false;
#endif
}

// Bytes up to the end of the next full group, or to the end of all; 0 when a code byte claims more than there
// is.
static size_t section_size(const uint8_t* in, size_t size) {
    size_t at = 0;
    uint8_t code = 0;
    while ((at < size) && (code != FULL_CODE)) {
        code = in[at];
        if (code > size - at) { return 0; }
        at += code;
    }
    return at;
}

// Within a section each code byte stands just where the zero in front of its group belongs, one place on: the
// section is moved in one piece and its codes, which lead from one to the next, become zeros. `out` holds
// what stood behind the section's first code. Returns the plain bytes of the section: more than `size` when a
// code byte claims more than there is.
static size_t put_zeros(uint8_t code, uint8_t* out, size_t size) {
    size_t at = (size_t)code - 1U;
    while ((at < size) && (code != FULL_CODE)) {
        code = out[at];
        out[at] = 0U;
        at += code;
    }
    return at;
}

// What is short is moved as a whole, whatever its sections: following the codes takes most of the time, and
// to find a section's end first would be a second time.
#define MOVED_MAX 1024U

glp_cobs_result glp_cobs_decode(const uint8_t* in, size_t size, uint8_t* out, size_t capacity) {
    const glp_cobs_result refused = {glp_status_bad_cobs, 0};
    if ((size == 0U) || has_zero(in, size)) { return refused; }
    size_t written = 0;
    for (size_t left = size; left > 0U;) {
        const uint8_t code = *in;
        // An empty group at the very end says "no zero here". Behind a full group that was said already.
        if ((left < size) && (left == 1U) && (code == 1U)) { return refused; }
        const bool whole = (left - 1U <= capacity - written) && (left <= MOVED_MAX);
        size_t moved = left - 1U;
        if (!whole) {
            const size_t section = section_size(in, left);
            if (section == 0U) { return refused; }
            if (section - 1U > capacity - written) { return (glp_cobs_result){glp_status_no_space, 0}; }
            moved = section - 1U;
        }
        memmove(out + written, in + 1, moved);
        const size_t plain = put_zeros(code, out + written, moved);
        if (plain > moved) { return refused; }
        in = whole ? out + written + plain : in + 1 + plain;  // in place, the former place is overwritten
        left -= plain + 1U;
        written += plain;
    }
    return (glp_cobs_result){glp_status_ok, written};
}
