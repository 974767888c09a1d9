/// The board's own state machine: identify, configure, stream, account for what could not be sent (SPEC.md,
/// Device).
///
/// Invariants:
///   - Every sampling instant takes one index, whether its sample was kept or lost, and a loss is counted
///     exactly: samples in the frames made so far + lost_samples == index of the next instant not yet dealt
///     with.
///   - Every frame takes one sequence number when it is made. A frame that finds no room in the ring is
///     dropped whole: the wire never carries a torn frame, and the host sees the missing number.
///   - The samples of one frame are consecutive, and taken under one configuration.
///   - While it streams the index keeps pace with the nominal rate: where the sensor's interrupt stays away,
///     its instants are counted and lost.
///   - Nothing here waits for the host, and nothing is allocated.
///
/// Threads: glp_board_on_data_ready and glp_board_on_sampling_instant may interrupt the others on a
/// single-core device; they write only the queue of instants. All other calls belong to one main loop.
#ifndef GYROLOG_PROTOCOL_DEVICE_BOARD_H
#define GYROLOG_PROTOCOL_DEVICE_BOARD_H

#include <gyrolog_protocol/frame.h>
#include <gyrolog_protocol/frame_stream.h>
#include <gyrolog_protocol/message.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "frame_ring.h"
#include "hal.h"
#include "mpu9250.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Instants that may wait for the main loop: a power of two, 8 bytes each. The FIFO holds 42 samples of gyro
/// and accel.
#ifndef GLP_BOARD_INSTANTS
    #define GLP_BOARD_INSTANTS 128U
#endif
/// The least ring that glp_board_init takes: one frame of the largest size beside the room kept for short
/// frames.
#define GLP_BOARD_RING_MIN 2048U

/// What a port knows about itself at boot.
typedef struct glp_board_identity {
    uint8_t uid[GLP_UID_BYTES];
    const char* firmware;  ///< At most GLP_FIRMWARE_BYTES characters
    uint32_t tick_hz;
    uint8_t tick_bits;      ///< 32 to 64
    uint32_t rate_max_mHz;  ///< Fastest output rate this port can keep up with; 0 for no limit.
                            ///< CONFIGURE above it is refused
    uint32_t boot_id;
    glp_reset_cause reset_cause;
} glp_board_identity;

/// The fields are the module's own; a test may look at them. A port places one in static memory.
typedef struct glp_board {
    const glp_hal* hal;
    glp_board_identity identity;
    uint64_t tick_mask;
    uint8_t who_am_i;
    bool sensor_ready;              ///< Set up, and its state not in doubt since
    glp_mpu_outcome setup_outcome;  ///< Of the last set-up, until an EVENT has told it
    glp_mpu_fault setup_fault;
    bool dtr;

    glp_mpu_settings settings;
    glp_mpu_plan plan;
    glp_config config;                ///< As the host is told
    uint8_t samples_per_frame_asked;  ///< 0: the board chooses
    uint64_t period_ticks;            ///< Nominal, of the output rate
    uint64_t patience_ticks;          ///< No sample waits longer for its frame to fill
    uint64_t silence_ticks;           ///< Without an interrupt: the samples of that time are lost

    // Written by the interrupt while `armed`.
    volatile bool armed;
    volatile uint16_t interrupts_to_skip;  ///< Until the next instant, where the board decimates
    volatile uint32_t instants;            ///< Modulo 2^32
    volatile uint64_t instant_ticks[GLP_BOARD_INSTANTS];

    // Accounts since the start.
    bool streaming;
    uint32_t instants_done;   ///< Of `instants`, how many are in a frame or counted lost
    uint64_t next_index;      ///< Of the oldest instant not yet dealt with
    uint64_t previous_ticks;  ///< Of the instant before it
    bool previous_known;
    bool silent;            ///< The interrupt stays away
    uint64_t heard_ticks;   ///< Of the last instant that was dealt with, with or without an interrupt
    uint64_t mended_ticks;  ///< When the sensor was last looked after because its interrupt stayed away
    uint32_t lost_samples;
    uint32_t lost_frames;
    uint32_t fifo_overflows;
    uint32_t bus_errors;
    int16_t temperature;

    // Losses on their way to the host.
    bool resync;            ///< The FIFO's content is not to be trusted: empty it before the next read
    uint16_t resync_flags;  ///< Why
    uint16_t next_flags;    ///< For the next SAMPLES frame
    uint16_t untold_flags;  ///< For the next EVENT, as are the following
    uint32_t untold_samples;
    uint64_t untold_index;
    uint64_t told_ticks;
    uint32_t untold_frames;

    // The frame that is being filled.
    uint8_t payload[GLP_FRAME_PAYLOAD_MAX];
    uint8_t frame_samples;
    uint16_t frame_flags;
    uint64_t frame_ticks;
    uint64_t frame_index;

    uint32_t sequence;  ///< Of the next frame
    uint64_t hello_ticks;
    uint64_t status_ticks;
    uint8_t wire[GLP_FRAME_WIRE_MAX];
    glp_frame_ring ring;
    glp_stream commands;
} glp_board;

/// `ring` is where frames wait for the host; 4 KiB ride out 1.5 s at 100 Hz. `hal` and `ring` must outlive
/// the board. False when the ring is smaller than GLP_BOARD_RING_MIN, or tick_bits is not 32 to 64 or too few
/// for 10 s.
bool glp_board_init(glp_board* self, const glp_hal* hal, const glp_board_identity* identity, uint8_t* ring,
                    size_t ring_bytes);
/// Resets and sets up the sensor with the default configuration: 100 Hz, gyro 500 dps and accel 8 g, DLPF 41
/// Hz. False when the bus fails, or WHO_AM_I or a read-back is wrong: the board then still answers, and says
/// so in an EVENT.
bool glp_board_boot(glp_board* self);

/// The sensor's data-ready interrupt, with the tick at which it came. Counts to the k-th where the board
/// decimates.
void glp_board_on_data_ready(glp_board* self, uint64_t ticks);
/// The same for a port that has done that counting elsewhere: by a timer that counts the pin, or, where the
/// pin cannot show single samples (at 32 kHz its 50 us pulses merge), by a timer of the output rate.
void glp_board_on_sampling_instant(glp_board* self, uint64_t ticks);
/// The host's SET_CONTROL_LINE_STATE. A rising DTR starts the stream, a falling one stops it. A port reports
/// a bus reset, a suspend or an unplugged cable as DTR low.
void glp_board_on_line_state(glp_board* self, bool dtr);
/// Bytes from the OUT endpoint.
void glp_board_on_receive(glp_board* self, const uint8_t* bytes, size_t size);
/// One turn of the main loop: read the sensor, build frames, feed the endpoint, send what is due.
void glp_board_poll(glp_board* self);

#ifdef __cplusplus
}
#endif

#endif
