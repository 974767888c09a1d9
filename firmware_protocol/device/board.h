/// The board's own state machine: identify, configure, stream, account for what could not be sent (SPEC.md, Device).
///
/// Invariants:
///   - Every sampling instant takes one index, whether its sample was kept or lost.
///   - Every frame takes one sequence number when it is made. A frame that finds no room in the ring is dropped whole:
///     the wire never carries a torn frame, and the host sees the missing number.
///   - Nothing here waits for the host, and nothing is allocated.
///
/// Threads: glp_board_on_data_ready may interrupt the others on a single-core device; it writes only the pending
/// interrupts' queue. All other calls belong to one main loop.
#ifndef GYROLOG_PROTOCOL_DEVICE_BOARD_H
#define GYROLOG_PROTOCOL_DEVICE_BOARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gyrolog_protocol/frame.h>
#include <gyrolog_protocol/frame_stream.h>
#include <gyrolog_protocol/message.h>

#include "hal.h"
#include "mpu9250.h"

/// What a port knows about itself at boot.
typedef struct glp_board_identity {
    uint8_t uid[GLP_UID_BYTES];
    const char* firmware;  ///< At most GLP_FIRMWARE_BYTES characters
    uint32_t tick_hz;
    uint8_t tick_bits;
    uint32_t boot_id;
    glp_reset_cause reset_cause;
} glp_board_identity;

typedef struct glp_board glp_board;  // defined below; a port may place it in static memory

/// `ring` is where frames wait for the host; 4 KiB ride out 2 s at 100 Hz.
void glp_board_init(glp_board* self, const glp_hal* hal, const glp_board_identity* identity, uint8_t* ring,
                    size_t ring_bytes);
/// Resets and sets up the sensor with the default configuration. False when WHO_AM_I or a read-back is wrong: the
/// board then still answers, and says so in an EVENT.
bool glp_board_boot(glp_board* self);

/// The sensor's data-ready interrupt, with the tick at which it came.
void glp_board_on_data_ready(glp_board* self, uint64_t ticks);
/// The host's SET_CONTROL_LINE_STATE. A rising DTR starts the stream, a falling one stops it.
void glp_board_on_line_state(glp_board* self, bool dtr);
/// Bytes from the OUT endpoint.
void glp_board_on_receive(glp_board* self, const uint8_t* bytes, size_t size);
/// One turn of the main loop: read the sensor, build frames, feed the endpoint, send what is due.
void glp_board_poll(glp_board* self);

