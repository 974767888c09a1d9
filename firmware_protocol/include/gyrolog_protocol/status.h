/// Outcome of every call that judges bytes.
#ifndef GYROLOG_PROTOCOL_STATUS_H
#define GYROLOG_PROTOCOL_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum glp_status {
    glp_status_ok = 0,
    glp_status_bad_cobs,    ///< A code byte points past the end, or a zero stands inside an encoded frame.
    glp_status_bad_length,  ///< Too short or too long for a frame, or for the message that its type promises.
    glp_status_bad_crc,     ///< The checksum does not agree.
    glp_status_bad_version,  ///< Intact, but of another major version.
    glp_status_bad_value,    ///< Intact, but a field holds a value that the specification forbids.
    glp_status_no_space,     ///< The caller's buffer is too small.
    glp_status_count         ///< Number of the above; not a status.
} glp_status;

/// A constant name such as "bad_crc", as the conformance vectors spell it.
const char* glp_status_name(glp_status status);

#ifdef __cplusplus
}
#endif

#endif
