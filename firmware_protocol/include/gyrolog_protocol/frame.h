/// One frame: header, payload, checksum (SPEC.md, Frames).
///
///   wire = 00, COBS(body), 00        body = header (8 bytes), payload, CRC-32 of both; little endian
///   header = version u8, type u8, flags u16, sequence u32
#ifndef GYROLOG_PROTOCOL_FRAME_H
#define GYROLOG_PROTOCOL_FRAME_H

#include <stddef.h>
#include <stdint.h>

#include "cobs.h"
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLP_FRAME_HEADER_BYTES 8U
#define GLP_FRAME_CRC_BYTES 4U
#define GLP_FRAME_BODY_MAX 1016U
#define GLP_FRAME_BODY_MIN (GLP_FRAME_HEADER_BYTES + GLP_FRAME_CRC_BYTES)
#define GLP_FRAME_PAYLOAD_MAX (GLP_FRAME_BODY_MAX - GLP_FRAME_BODY_MIN)
/// COBS form without delimiters, at the most. 1016 = 4 * 254: no code byte follows the last full group.
#define GLP_FRAME_ENCODED_MAX 1020U
/// With both delimiters.
#define GLP_FRAME_WIRE_MAX (GLP_FRAME_ENCODED_MAX + 2U)

typedef enum glp_frame_type {
    glp_frame_hello = 0x01,
    glp_frame_config = 0x02,
    glp_frame_samples = 0x03,
    glp_frame_status = 0x04,
    glp_frame_event = 0x05,
    glp_frame_reply = 0x06,
    /// Commands, host to device, have the top bit set.
    glp_frame_get_hello = 0x81,
    glp_frame_configure = 0x82,
    glp_frame_start = 0x83,
    glp_frame_stop = 0x84,
    glp_frame_get_status = 0x85
} glp_frame_type;

/// Flags of a SAMPLES frame: what happened between the sample before and the frame's first one. Other frames:
/// 0.
enum {
    glp_flag_sensor_fifo_overflow = 0x0001,  ///< The FIFO or the data registers, read too late
    glp_flag_bus_error = 0x0002,
    glp_flag_ring_overflow = 0x0004,
    glp_flag_first_after_start = 0x0008,
    glp_flag_time_discontinuity = 0x0010,
    glp_flag_saturated = 0x0020,  ///< A sample of this frame stands at the end of the sensor's code range.
    glp_flag_data_ready_silent = 0x0040  ///< The sensor's interrupt stayed away
};

/// A view: the payload belongs to whoever made the frame.
typedef struct glp_frame {
    uint8_t type;
    uint16_t flags;
    uint32_t sequence;
    const uint8_t* payload;
    size_t payload_bytes;
} glp_frame;

/// Writes the frame with both delimiters. Needs at most GLP_FRAME_WIRE_MAX bytes of `capacity`.
/// Status: ok; bad_length when the payload exceeds GLP_FRAME_PAYLOAD_MAX; no_space.
glp_cobs_result glp_frame_encode(const glp_frame* frame, uint8_t* wire, size_t capacity);

/// Judges the bytes between two delimiters (COBS form). `body` receives the decoded bytes, and the frame's
/// payload points into it. Status: ok, bad_cobs, bad_length, bad_crc, bad_version.
glp_status glp_frame_decode(const uint8_t* encoded, size_t size, uint8_t body[GLP_FRAME_BODY_MAX],
                            glp_frame* frame);

#ifdef __cplusplus
}
#endif

#endif
