/// Consistent overhead byte stuffing: the encoded form holds no zero byte.
#ifndef GYROLOG_PROTOCOL_COBS_H
#define GYROLOG_PROTOCOL_COBS_H

#include <stddef.h>
#include <stdint.h>

#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Bytes that `n` plain bytes need at the most once encoded.
#define GLP_COBS_ENCODED_MAX(n) ((n) + ((n) / 254U) + 1U)

typedef struct glp_cobs_result {
    glp_status status;  ///< ok, no_space, or (decoding) bad_cobs
    size_t size;        ///< Bytes written; 0 unless ok
} glp_cobs_result;

/// Neither call writes past `capacity`. glp_cobs_decode may work in place (`out == in`).
/// One sequence of bytes has one encoded form: a full last group is not followed by an empty one, and the
/// decoder refuses it (SPEC.md, COBS).
glp_cobs_result glp_cobs_encode(const uint8_t* in, size_t size, uint8_t* out, size_t capacity);
glp_cobs_result glp_cobs_decode(const uint8_t* in, size_t size, uint8_t* out, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
