#include <gyrolog_protocol/frame_stream.h>

#include "memory.h"

void glp_stream_init(glp_stream* self) { *self = (glp_stream){0}; }

size_t glp_stream_buffered(const glp_stream* self) {
    return self->encoded_bytes + (self->leading_delimiter ? 1U : 0U);
}

// Bytes before the first delimiter; `size` when there is none.
static size_t bytes_to_delimiter(const uint8_t* bytes, size_t size) {
#if __STDC_HOSTED__
    const uint8_t* delimiter = memchr(bytes, 0, size);
    return (delimiter == NULL) ? size : (size_t)(delimiter - bytes);
#else
    size_t i = 0;
    while ((i < size) && (bytes[i] != 0U)) { ++i; }
    return i;
#endif
}

static void drop_candidate(glp_stream* self) {
    self->bytes_skipped += glp_stream_buffered(self);
    self->encoded_bytes = 0;
    self->leading_delimiter = false;
}

static void collect(glp_stream* self, const uint8_t* bytes, size_t size) {
    if (!self->overlong && (size > GLP_FRAME_ENCODED_MAX - self->encoded_bytes)) {
        drop_candidate(self);
        self->overlong = true;
    }
    if (self->overlong) {
        self->bytes_skipped += size;
        return;
    }
    memcpy(self->buffer + self->encoded_bytes, bytes, size);
    self->encoded_bytes += size;
}

// A delimiter has come behind the candidate at `encoded`, which is the buffer or, when it lies there in one
// piece, the caller's bytes. Accounts for both.
static bool close_candidate(glp_stream* self, const uint8_t* encoded, glp_frame* frame) {
    if (self->overlong) {
        self->overlong = false;
        self->leading_delimiter = true;
        ++self->rejected[glp_status_bad_length];
        return false;
    }
    if (self->encoded_bytes == 0U) {
        self->bytes_skipped += glp_stream_buffered(self);
        self->leading_delimiter = true;
        return false;
    }
    const glp_status status = glp_frame_decode(encoded, self->encoded_bytes, self->buffer, frame);
    if (status != glp_status_ok) {
        ++self->rejected[status];
        drop_candidate(self);
        // What closed the refused candidate may open the next frame.
        self->leading_delimiter = true;
        return false;
    }
    self->bytes_in_frames += glp_stream_buffered(self) + 1U;
    ++self->frames;
    self->encoded_bytes = 0;
    self->leading_delimiter = false;
    return true;
}

size_t glp_stream_push(glp_stream* self, const uint8_t* bytes, size_t size, glp_frame* frame,
                       bool* have_frame) {
    *have_frame = false;
    size_t taken = 0;
    while ((taken < size) && !*have_frame) {
        const uint8_t* piece = bytes + taken;
        const size_t before_delimiter = bytes_to_delimiter(piece, size - taken);
        const bool delimited = before_delimiter < size - taken;
        taken += before_delimiter + (delimited ? 1U : 0U);
        self->bytes_in += before_delimiter + (delimited ? 1U : 0U);

        const uint8_t* encoded = self->buffer;
        const bool in_one_piece = delimited && !self->overlong && (self->encoded_bytes == 0U) &&
                                  (before_delimiter <= GLP_FRAME_ENCODED_MAX);
        if (in_one_piece) {
            encoded = piece;
            self->encoded_bytes = before_delimiter;
        } else {
            collect(self, piece, before_delimiter);
        }
        if (delimited) { *have_frame = close_candidate(self, encoded, frame); }
    }
    return taken;
}
