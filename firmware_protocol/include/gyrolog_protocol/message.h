/// The payloads of the device's frames (SPEC.md, Messages). Little endian, no padding; offsets stand in
/// SPEC.md.
///
/// Each pair: glp_X_write fills `payload` and returns its size (0 when it does not fit or a field is out of
/// range); glp_X_read judges a received frame: ok, bad_length, bad_value. A longer payload than this minor
/// version knows is accepted and its tail ignored (SPEC.md, Versioning), except in SAMPLES, whose length is
/// exact.
#ifndef GYROLOG_PROTOCOL_MESSAGE_H
#define GYROLOG_PROTOCOL_MESSAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "frame.h"
#include "status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLP_UID_BYTES 16U
#define GLP_FIRMWARE_BYTES 24U
#define GLP_SENSOR_BYTES 16U

/// HELLO, 72 bytes: who is speaking. Sent when the host raises DTR, on request, and every 5 s while
/// streaming.
typedef struct glp_hello {
    uint8_t protocol_major;
    uint8_t protocol_minor;
    uint8_t tick_bits;  ///< Width of the device's tick counter, 32 to 64; ticks are modulo 2^tick_bits
    uint8_t who_am_i;   ///< The sensor's WHO_AM_I register as read
    uint32_t tick_hz;
    uint32_t boot_id;     ///< Differs from boot to boot: tells a reset from a gap
    uint8_t reset_cause;  ///< glp_reset_cause
    uint8_t uid[GLP_UID_BYTES];
    char firmware[GLP_FIRMWARE_BYTES + 1U];  ///< Text, NUL-terminated here, NUL-padded on the wire
    char sensor[GLP_SENSOR_BYTES + 1U];
} glp_hello;

typedef enum glp_reset_cause {
    glp_reset_unknown = 0,
    glp_reset_power_on = 1,
    glp_reset_pin = 2,
    glp_reset_watchdog = 3,
    glp_reset_brown_out = 4,
    glp_reset_software = 5
} glp_reset_cause;

/// Which parts a sample has, in this order: gyro x y z (6 bytes), accel x y z (6), temperature (2).
enum { glp_layout_gyro = 0x01, glp_layout_accel = 0x02, glp_layout_temperature = 0x04 };

/// CONFIG, 40 bytes: the configuration in force. Sent after each HELLO and after each change.
typedef struct glp_config {
    uint16_t generation;  ///< Counts changes since boot; SAMPLES name the one they were taken under
    uint8_t layout;
    uint8_t samples_per_frame;
    uint32_t rate_mHz;  ///< Nominal output rate in millihertz
    uint16_t gyro_full_scale_dps;
    uint16_t accel_full_scale_g;
    uint16_t dlpf_hz;            ///< Gyro bandwidth by the register map, 0 when the filter is bypassed
    uint16_t decimation;         ///< The board takes every k-th sample that the sensor makes; 1 takes all
    uint32_t gyro_ndps_per_lsb;  ///< Nanodegrees per second for one count
    uint32_t accel_pg_per_lsb;   ///< Pico-g for one count (8 g at 4096 LSB/g: 244140625)
    uint32_t temp_nC_per_lsb;    ///< Nanokelvin for one count
    int32_t temp_offset_mC;      ///< Temperature at count 0, thousandths of a degree Celsius
    uint8_t registers[8];  ///< Read back: SMPLRT_DIV CONFIG GYRO_CONFIG ACCEL_CONFIG ACCEL_CONFIG2 FIFO_EN
                           ///< INT_ENABLE USER_CTRL
} glp_config;

#define GLP_SAMPLES_HEADER_BYTES 28U

/// SAMPLES: consecutive samples. Sample i of the frame has index first_index + i; indices count every
/// sampling instant since the start, so a jump is exactly the number of samples lost.
typedef struct glp_samples {
    uint64_t first_ticks;  ///< Device ticks at the data-ready interrupt of the first sample
    uint64_t first_index;
    uint16_t config_generation;
    int16_t temperature;    ///< Counts, read once a frame
    uint32_t lost_samples;  ///< Lost on the device since the start
    uint8_t count;          ///< 1 or more
    uint8_t layout;
    const uint8_t* samples;  ///< count times glp_sample_bytes(layout)
} glp_samples;

/// Bytes of one sample; 0 for a layout the specification does not know.
size_t glp_sample_bytes(uint8_t layout);
/// Samples of this layout that fit one frame.
size_t glp_samples_per_frame_max(uint8_t layout);
/// The int16 at place `field` of sample `i`: 0 to glp_sample_bytes(layout)/2 - 1.
int16_t glp_sample_field(const glp_samples* samples, size_t i, size_t field);

/// STATUS, 48 bytes, once a second while streaming: the device's own accounts.
typedef struct glp_device_status {
    uint64_t ticks;
    uint64_t next_index;  ///< Index of the next sampling instant
    uint32_t lost_samples;
    uint32_t lost_frames;  ///< Frames dropped because the host did not take them; their numbers are used up
    uint32_t ring_bytes;
    uint32_t ring_high_water_bytes;
    uint32_t usb_frame_number;  ///< Count of start-of-frame tokens, 1 kHz on full speed; 0 when unknown
    uint32_t fifo_overflows;
    uint32_t bus_errors;
    int16_t temperature;
    uint8_t streaming;  ///< 0 or 1
    uint8_t reset_cause;
} glp_device_status;

/// EVENT, 24 bytes and up to 96 bytes of UTF-8 text.
#define GLP_EVENT_TEXT_MAX 96U
typedef enum glp_event_code {
    glp_event_started = 1,
    glp_event_stopped = 2,
    glp_event_sensor_fifo_overflow = 3,
    glp_event_bus_error = 4,
    glp_event_ring_overflow = 5,
    glp_event_sensor_fault =
        6,  ///< WHO_AM_I or a register read back wrong; value = register << 8 | value read
    glp_event_text = 7,
    glp_event_data_ready_silent = 8  ///< The sensor's interrupt stayed away; value = samples lost
} glp_event_code;

typedef struct glp_event {
    uint64_t ticks;
    uint64_t index;  ///< Next sampling instant when it happened
    uint16_t code;
    int32_t value;  ///< By code: samples or frames lost, register read, ...
    const char* text;
    size_t text_bytes;
} glp_event;

/// REPLY, 8 bytes: the answer to one command.
typedef enum glp_result {
    glp_result_ok = 0,
    glp_result_unknown_command = 1,
    glp_result_bad_length = 2,
    glp_result_bad_value = 3,  ///< A rate, range, bandwidth or layout that the sensor does not have
    glp_result_sensor_fault = 4
} glp_result;

typedef struct glp_reply {
    uint32_t command_sequence;
    uint8_t command_type;
    uint8_t result;
} glp_reply;

/// CONFIGURE (command), 16 bytes. 0 in a field means "leave as it is", but for samples_per_frame, where the
/// board then chooses; dlpf_hz 0xFFFF bypasses the filter.
#define GLP_DLPF_OFF 0xFFFFU
typedef struct glp_configure {
    uint32_t rate_mHz;
    uint16_t gyro_full_scale_dps;
    uint16_t accel_full_scale_g;
    uint16_t dlpf_hz;
    uint8_t layout;
    uint8_t samples_per_frame;
} glp_configure;

size_t glp_hello_write(const glp_hello* hello, uint8_t* payload, size_t capacity);
glp_status glp_hello_read(const glp_frame* frame, glp_hello* hello);
size_t glp_config_write(const glp_config* config, uint8_t* payload, size_t capacity);
glp_status glp_config_read(const glp_frame* frame, glp_config* config);
size_t glp_samples_write(const glp_samples* samples, uint8_t* payload, size_t capacity);
glp_status glp_samples_read(const glp_frame* frame, glp_samples* samples);
size_t glp_device_status_write(const glp_device_status* status, uint8_t* payload, size_t capacity);
glp_status glp_device_status_read(const glp_frame* frame, glp_device_status* status);
size_t glp_event_write(const glp_event* event, uint8_t* payload, size_t capacity);
glp_status glp_event_read(const glp_frame* frame, glp_event* event);
size_t glp_reply_write(const glp_reply* reply, uint8_t* payload, size_t capacity);
glp_status glp_reply_read(const glp_frame* frame, glp_reply* reply);
size_t glp_configure_write(const glp_configure* configure, uint8_t* payload, size_t capacity);
glp_status glp_configure_read(const glp_frame* frame, glp_configure* configure);

#ifdef __cplusplus
}
#endif

#endif
