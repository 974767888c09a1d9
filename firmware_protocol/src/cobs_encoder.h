/// COBS of bytes that come in pieces: a frame's header, payload and checksum need not lie side by side.
#ifndef GYROLOG_PROTOCOL_SRC_COBS_ENCODER_H
#define GYROLOG_PROTOCOL_SRC_COBS_ENCODER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Invariants: out[code_at] is the code byte of the open group, not yet written; `size` never exceeds
/// `capacity`. After a full group none is open until another byte comes: that is what keeps the form unique.
typedef struct glp_cobs_encoder {
    uint8_t* out;
    size_t capacity;
    size_t size;
    size_t code_at;
    uint8_t code;
    bool open;
} glp_cobs_encoder;

/// Each returns false when the capacity does not suffice.
bool glp_cobs_begin(glp_cobs_encoder* self, uint8_t* out, size_t capacity);
bool glp_cobs_put(glp_cobs_encoder* self, const uint8_t* bytes, size_t size);
void glp_cobs_end(glp_cobs_encoder* self);

#endif
