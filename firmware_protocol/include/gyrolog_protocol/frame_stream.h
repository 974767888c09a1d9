/// Resynchronising reader over an unreliable byte stream.
///
/// Invariants, true after every call:
///   - bytes_in == bytes_in_frames + bytes_skipped + glp_stream_buffered(). No byte is ever unaccounted for.
///   - A delimiter always ends what stood before it: damage costs the frames it touches and no other.
///   - At most GLP_FRAME_ENCODED_MAX bytes are kept, whatever comes in.
///
/// Who owns a delimiter: an intact frame owns the delimiter behind it, and the one directly in front of it
/// unless that one closed the frame before. Every other delimiter is skipped once the byte after it is known.
#ifndef GYROLOG_PROTOCOL_FRAME_STREAM_H
#define GYROLOG_PROTOCOL_FRAME_STREAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "frame.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct glp_stream {
    uint8_t buffer[GLP_FRAME_ENCODED_MAX];  ///< The candidate while it comes in, then its decoded body
    size_t encoded_bytes;                   ///< Of the candidate that is being collected
    bool leading_delimiter;  ///< A delimiter stands in front of the candidate and belongs to nobody yet
    bool overlong;           ///< The candidate has outgrown a frame: skip up to the next delimiter
    uint64_t bytes_in;
    uint64_t bytes_in_frames;
    uint64_t bytes_skipped;
    uint64_t frames;                      ///< Intact frames
    uint64_t rejected[glp_status_count];  ///< Candidates refused, by reason
} glp_stream;

void glp_stream_init(glp_stream* self);

/// Takes bytes until a frame is complete or all are taken; returns how many were taken. `*have_frame` tells
/// whether `frame` was filled; its payload is valid until the next call on this stream. Call again with the
/// rest.
size_t glp_stream_push(glp_stream* self, const uint8_t* bytes, size_t size, glp_frame* frame,
                       bool* have_frame);

/// Bytes that wait for the rest of their frame.
size_t glp_stream_buffered(const glp_stream* self);

#ifdef __cplusplus
}
#endif

#endif
