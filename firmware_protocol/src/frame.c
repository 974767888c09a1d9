#include <gyrolog_protocol/crc.h>
#include <gyrolog_protocol/frame.h>
#include <gyrolog_protocol/version.h>

#include "cobs_encoder.h"
#include "little_endian.h"

glp_cobs_result glp_frame_encode(const glp_frame* frame, uint8_t* wire, size_t capacity) {
    if (frame->payload_bytes > GLP_FRAME_PAYLOAD_MAX) { return (glp_cobs_result){glp_status_bad_length, 0}; }
    const glp_cobs_result no_space = {glp_status_no_space, 0};
    if (capacity < 2U) { return no_space; }

    uint8_t header[GLP_FRAME_HEADER_BYTES];
    header[0] = GLP_PROTOCOL_MAJOR;
    header[1] = frame->type;
    glp_store_u16(header + 2, frame->flags);
    glp_store_u32(header + 4, frame->sequence);

    uint8_t checksum[GLP_FRAME_CRC_BYTES];
    const uint32_t header_crc = glp_crc32(header, sizeof header);
    glp_store_u32(checksum, glp_crc32_continue(header_crc, frame->payload, frame->payload_bytes));

    glp_cobs_encoder encoder;
    if (!glp_cobs_begin(&encoder, wire + 1, capacity - 2U) ||
        !glp_cobs_put(&encoder, header, sizeof header) ||
        !glp_cobs_put(&encoder, frame->payload, frame->payload_bytes) ||
        !glp_cobs_put(&encoder, checksum, sizeof checksum)) {
        return no_space;
    }
    glp_cobs_end(&encoder);
    wire[0] = 0U;
    wire[encoder.size + 1U] = 0U;
    return (glp_cobs_result){glp_status_ok, encoder.size + 2U};
}

glp_status glp_frame_decode(const uint8_t* encoded, size_t size, uint8_t body[GLP_FRAME_BODY_MAX],
                            glp_frame* frame) {
    if (size > GLP_FRAME_ENCODED_MAX) { return glp_status_bad_length; }
    const glp_cobs_result plain = glp_cobs_decode(encoded, size, body, GLP_FRAME_BODY_MAX);
    if (plain.status == glp_status_no_space) { return glp_status_bad_length; }
    if (plain.status != glp_status_ok) { return plain.status; }
    if (plain.size < GLP_FRAME_BODY_MIN) { return glp_status_bad_length; }

    const size_t checked_bytes = plain.size - GLP_FRAME_CRC_BYTES;
    if (glp_crc32(body, checked_bytes) != glp_load_u32(body + checked_bytes)) { return glp_status_bad_crc; }
    // Judged after the checksum: "another version" is then a statement of the sender, not a damaged byte.
    if (body[0] != GLP_PROTOCOL_MAJOR) { return glp_status_bad_version; }

    frame->type = body[1];
    frame->flags = glp_load_u16(body + 2);
    frame->sequence = glp_load_u32(body + 4);
    frame->payload = body + GLP_FRAME_HEADER_BYTES;
    frame->payload_bytes = checked_bytes - GLP_FRAME_HEADER_BYTES;
    return glp_status_ok;
}
