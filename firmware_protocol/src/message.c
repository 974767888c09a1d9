#include <gyrolog_protocol/message.h>
#include <stdbool.h>

#include "little_endian.h"
#include "memory.h"

enum {
    HELLO_BYTES = 72,
    CONFIG_BYTES = 40,
    STATUS_BYTES = 48,
    EVENT_BYTES = 24,
    REPLY_BYTES = 8,
    CONFIGURE_BYTES = 16
};

#define KNOWN_LAYOUTS (glp_layout_gyro | glp_layout_accel | glp_layout_temperature)

static int16_t load_i16(const uint8_t* bytes) { return (int16_t)glp_load_u16(bytes); }
static int32_t load_i32(const uint8_t* bytes) { return (int32_t)glp_load_u32(bytes); }

static bool layout_is_known(uint8_t layout) {
    return (layout != 0U) && ((layout & (uint8_t)~KNOWN_LAYOUTS) == 0U);
}

size_t glp_sample_bytes(uint8_t layout) {
    if (!layout_is_known(layout)) { return 0; }
    return (((layout & glp_layout_gyro) != 0) ? 6U : 0U) + (((layout & glp_layout_accel) != 0) ? 6U : 0U) +
           (((layout & glp_layout_temperature) != 0) ? 2U : 0U);
}

size_t glp_samples_per_frame_max(uint8_t layout) {
    const size_t sample_bytes = glp_sample_bytes(layout);
    if (sample_bytes == 0U) { return 0; }
    const size_t fit = (GLP_FRAME_PAYLOAD_MAX - GLP_SAMPLES_HEADER_BYTES) / sample_bytes;
    return (fit < UINT8_MAX) ? fit : UINT8_MAX;
}

int16_t glp_sample_field(const glp_samples* samples, size_t i, size_t field) {
    return load_i16(samples->samples + i * glp_sample_bytes(samples->layout) + 2U * field);
}

// ---------------------------------------------------------------------------------------------------- HELLO

static void store_text(uint8_t* bytes, size_t size, const char* text) {
    size_t length = 0;
    while ((length < size) && (text[length] != '\0')) { ++length; }
    memcpy(bytes, text, length);
    memset(bytes + length, 0, size - length);
}

static void load_text(const uint8_t* bytes, size_t size, char* text) {
    size_t length = 0;
    while ((length < size) && (bytes[length] != 0U)) { ++length; }
    memcpy(text, bytes, length);
    memset(text + length, 0, size + 1U - length);
}

static bool hello_is_valid(const glp_hello* hello) {
    return (hello->protocol_major != 0U) && (hello->tick_bits >= 32U) && (hello->tick_bits <= 64U) &&
           (hello->tick_hz != 0U);
}

size_t glp_hello_write(const glp_hello* hello, uint8_t* payload, size_t capacity) {
    if ((capacity < HELLO_BYTES) || !hello_is_valid(hello)) { return 0; }
    payload[0] = hello->protocol_major;
    payload[1] = hello->protocol_minor;
    payload[2] = hello->tick_bits;
    payload[3] = hello->who_am_i;
    glp_store_u32(payload + 4, hello->tick_hz);
    glp_store_u32(payload + 8, hello->boot_id);
    payload[12] = hello->reset_cause;
    memset(payload + 13, 0, 3);
    memcpy(payload + 16, hello->uid, GLP_UID_BYTES);
    store_text(payload + 32, GLP_FIRMWARE_BYTES, hello->firmware);
    store_text(payload + 56, GLP_SENSOR_BYTES, hello->sensor);
    return HELLO_BYTES;
}

glp_status glp_hello_read(const glp_frame* frame, glp_hello* hello) {
    if (frame->payload_bytes < HELLO_BYTES) { return glp_status_bad_length; }
    const uint8_t* payload = frame->payload;
    hello->protocol_major = payload[0];
    hello->protocol_minor = payload[1];
    hello->tick_bits = payload[2];
    hello->who_am_i = payload[3];
    hello->tick_hz = glp_load_u32(payload + 4);
    hello->boot_id = glp_load_u32(payload + 8);
    hello->reset_cause = payload[12];
    memcpy(hello->uid, payload + 16, GLP_UID_BYTES);
    load_text(payload + 32, GLP_FIRMWARE_BYTES, hello->firmware);
    load_text(payload + 56, GLP_SENSOR_BYTES, hello->sensor);
    return hello_is_valid(hello) ? glp_status_ok : glp_status_bad_value;
}

// --------------------------------------------------------------------------------------------------- CONFIG

static bool config_is_valid(const glp_config* config) {
    return layout_is_known(config->layout) && (config->samples_per_frame != 0U) &&
           (config->samples_per_frame <= glp_samples_per_frame_max(config->layout)) &&
           (config->rate_mHz != 0U) && (config->decimation != 0U) && (config->gyro_ndps_per_lsb != 0U) &&
           (config->accel_pg_per_lsb != 0U) && (config->temp_nC_per_lsb != 0U);
}

size_t glp_config_write(const glp_config* config, uint8_t* payload, size_t capacity) {
    if ((capacity < CONFIG_BYTES) || !config_is_valid(config)) { return 0; }
    glp_store_u16(payload, config->generation);
    payload[2] = config->layout;
    payload[3] = config->samples_per_frame;
    glp_store_u32(payload + 4, config->rate_mHz);
    glp_store_u16(payload + 8, config->gyro_full_scale_dps);
    glp_store_u16(payload + 10, config->accel_full_scale_g);
    glp_store_u16(payload + 12, config->dlpf_hz);
    glp_store_u16(payload + 14, config->decimation);
    glp_store_u32(payload + 16, config->gyro_ndps_per_lsb);
    glp_store_u32(payload + 20, config->accel_pg_per_lsb);
    glp_store_u32(payload + 24, config->temp_nC_per_lsb);
    glp_store_u32(payload + 28, (uint32_t)config->temp_offset_mC);
    memcpy(payload + 32, config->registers, sizeof config->registers);
    return CONFIG_BYTES;
}

glp_status glp_config_read(const glp_frame* frame, glp_config* config) {
    if (frame->payload_bytes < CONFIG_BYTES) { return glp_status_bad_length; }
    const uint8_t* payload = frame->payload;
    config->generation = glp_load_u16(payload);
    config->layout = payload[2];
    config->samples_per_frame = payload[3];
    config->rate_mHz = glp_load_u32(payload + 4);
    config->gyro_full_scale_dps = glp_load_u16(payload + 8);
    config->accel_full_scale_g = glp_load_u16(payload + 10);
    config->dlpf_hz = glp_load_u16(payload + 12);
    config->decimation = glp_load_u16(payload + 14);
    config->gyro_ndps_per_lsb = glp_load_u32(payload + 16);
    config->accel_pg_per_lsb = glp_load_u32(payload + 20);
    config->temp_nC_per_lsb = glp_load_u32(payload + 24);
    config->temp_offset_mC = load_i32(payload + 28);
    memcpy(config->registers, payload + 32, sizeof config->registers);
    return config_is_valid(config) ? glp_status_ok : glp_status_bad_value;
}

// -------------------------------------------------------------------------------------------------- SAMPLES

size_t glp_samples_write(const glp_samples* samples, uint8_t* payload, size_t capacity) {
    const size_t sample_bytes = glp_sample_bytes(samples->layout);
    if ((sample_bytes == 0U) || (samples->count == 0U) ||
        (samples->count > glp_samples_per_frame_max(samples->layout))) {
        return 0;
    }
    const size_t size = GLP_SAMPLES_HEADER_BYTES + samples->count * sample_bytes;
    if (capacity < size) { return 0; }
    glp_store_u64(payload, samples->first_ticks);
    glp_store_u64(payload + 8, samples->first_index);
    glp_store_u16(payload + 16, samples->config_generation);
    glp_store_u16(payload + 18, (uint16_t)samples->temperature);
    glp_store_u32(payload + 20, samples->lost_samples);
    payload[24] = samples->count;
    payload[25] = samples->layout;
    glp_store_u16(payload + 26, 0);
    // The samples may have been gathered in place.
    if (samples->samples != payload + GLP_SAMPLES_HEADER_BYTES) {
        memcpy(payload + GLP_SAMPLES_HEADER_BYTES, samples->samples, samples->count * sample_bytes);
    }
    return size;
}

glp_status glp_samples_read(const glp_frame* frame, glp_samples* samples) {
    if (frame->payload_bytes < GLP_SAMPLES_HEADER_BYTES) { return glp_status_bad_length; }
    const uint8_t* payload = frame->payload;
    samples->first_ticks = glp_load_u64(payload);
    samples->first_index = glp_load_u64(payload + 8);
    samples->config_generation = glp_load_u16(payload + 16);
    samples->temperature = load_i16(payload + 18);
    samples->lost_samples = glp_load_u32(payload + 20);
    samples->count = payload[24];
    samples->layout = payload[25];
    samples->samples = payload + GLP_SAMPLES_HEADER_BYTES;
    const size_t sample_bytes = glp_sample_bytes(samples->layout);
    if ((sample_bytes == 0U) || (samples->count == 0U)) { return glp_status_bad_value; }
    const size_t size = GLP_SAMPLES_HEADER_BYTES + samples->count * sample_bytes;
    return (frame->payload_bytes == size) ? glp_status_ok : glp_status_bad_length;
}

// --------------------------------------------------------------------------------------------------- STATUS

size_t glp_device_status_write(const glp_device_status* status, uint8_t* payload, size_t capacity) {
    if ((capacity < STATUS_BYTES) || (status->streaming > 1U)) { return 0; }
    glp_store_u64(payload, status->ticks);
    glp_store_u64(payload + 8, status->next_index);
    glp_store_u32(payload + 16, status->lost_samples);
    glp_store_u32(payload + 20, status->lost_frames);
    glp_store_u32(payload + 24, status->ring_bytes);
    glp_store_u32(payload + 28, status->ring_high_water_bytes);
    glp_store_u32(payload + 32, status->usb_frame_number);
    glp_store_u32(payload + 36, status->fifo_overflows);
    glp_store_u32(payload + 40, status->bus_errors);
    glp_store_u16(payload + 44, (uint16_t)status->temperature);
    payload[46] = status->streaming;
    payload[47] = status->reset_cause;
    return STATUS_BYTES;
}

glp_status glp_device_status_read(const glp_frame* frame, glp_device_status* status) {
    if (frame->payload_bytes < STATUS_BYTES) { return glp_status_bad_length; }
    const uint8_t* payload = frame->payload;
    status->ticks = glp_load_u64(payload);
    status->next_index = glp_load_u64(payload + 8);
    status->lost_samples = glp_load_u32(payload + 16);
    status->lost_frames = glp_load_u32(payload + 20);
    status->ring_bytes = glp_load_u32(payload + 24);
    status->ring_high_water_bytes = glp_load_u32(payload + 28);
    status->usb_frame_number = glp_load_u32(payload + 32);
    status->fifo_overflows = glp_load_u32(payload + 36);
    status->bus_errors = glp_load_u32(payload + 40);
    status->temperature = load_i16(payload + 44);
    status->streaming = payload[46];
    status->reset_cause = payload[47];
    return (status->streaming <= 1U) ? glp_status_ok : glp_status_bad_value;
}

// ---------------------------------------------------------------------------------------------------- EVENT

size_t glp_event_write(const glp_event* event, uint8_t* payload, size_t capacity) {
    if ((event->text_bytes > GLP_EVENT_TEXT_MAX) || (capacity < EVENT_BYTES + event->text_bytes)) {
        return 0;
    }
    glp_store_u64(payload, event->ticks);
    glp_store_u64(payload + 8, event->index);
    glp_store_u16(payload + 16, event->code);
    payload[18] = (uint8_t)event->text_bytes;
    payload[19] = 0;
    glp_store_u32(payload + 20, (uint32_t)event->value);
    if (event->text_bytes > 0U) { memcpy(payload + EVENT_BYTES, event->text, event->text_bytes); }
    return EVENT_BYTES + event->text_bytes;
}

glp_status glp_event_read(const glp_frame* frame, glp_event* event) {
    if (frame->payload_bytes < EVENT_BYTES) { return glp_status_bad_length; }
    const uint8_t* payload = frame->payload;
    event->ticks = glp_load_u64(payload);
    event->index = glp_load_u64(payload + 8);
    event->code = glp_load_u16(payload + 16);
    event->text_bytes = payload[18];
    event->value = load_i32(payload + 20);
    event->text = (const char*)(payload + EVENT_BYTES);
    if (event->text_bytes > GLP_EVENT_TEXT_MAX) { return glp_status_bad_value; }
    return (event->text_bytes <= frame->payload_bytes - EVENT_BYTES) ? glp_status_ok : glp_status_bad_length;
}

// --------------------------------------------------------------------------------------- REPLY and CONFIGURE

size_t glp_reply_write(const glp_reply* reply, uint8_t* payload, size_t capacity) {
    if (capacity < REPLY_BYTES) { return 0; }
    glp_store_u32(payload, reply->command_sequence);
    payload[4] = reply->command_type;
    payload[5] = reply->result;
    glp_store_u16(payload + 6, 0);
    return REPLY_BYTES;
}

glp_status glp_reply_read(const glp_frame* frame, glp_reply* reply) {
    if (frame->payload_bytes < REPLY_BYTES) { return glp_status_bad_length; }
    reply->command_sequence = glp_load_u32(frame->payload);
    reply->command_type = frame->payload[4];
    reply->result = frame->payload[5];
    return glp_status_ok;
}

static bool configure_is_valid(const glp_configure* configure) {
    return (configure->layout == 0U) || layout_is_known(configure->layout);
}

size_t glp_configure_write(const glp_configure* configure, uint8_t* payload, size_t capacity) {
    if ((capacity < CONFIGURE_BYTES) || !configure_is_valid(configure)) { return 0; }
    glp_store_u32(payload, configure->rate_mHz);
    glp_store_u16(payload + 4, configure->gyro_full_scale_dps);
    glp_store_u16(payload + 6, configure->accel_full_scale_g);
    glp_store_u16(payload + 8, configure->dlpf_hz);
    payload[10] = configure->layout;
    payload[11] = configure->samples_per_frame;
    glp_store_u32(payload + 12, 0);
    return CONFIGURE_BYTES;
}

glp_status glp_configure_read(const glp_frame* frame, glp_configure* configure) {
    if (frame->payload_bytes < CONFIGURE_BYTES) { return glp_status_bad_length; }
    const uint8_t* payload = frame->payload;
    configure->rate_mHz = glp_load_u32(payload);
    configure->gyro_full_scale_dps = glp_load_u16(payload + 4);
    configure->accel_full_scale_g = glp_load_u16(payload + 6);
    configure->dlpf_hz = glp_load_u16(payload + 8);
    configure->layout = payload[10];
    configure->samples_per_frame = payload[11];
    return configure_is_valid(configure) ? glp_status_ok : glp_status_bad_value;
}
