#include "board.h"

#include <gyrolog_protocol/version.h>

#include "../src/memory.h"

enum {
    // What SAMPLES leave free, so that a HELLO with its CONFIG, a REPLY or an EVENT gets through a full ring.
    SHORT_FRAMES_RESERVE = 192,
    PATIENCE_MS = 100,
    FRAME_SPAN_MS = 40,
    STATUS_PERIOD_S = 1,
    HELLO_PERIOD_S = 5,
    // No sensor's clock and no decimation by a timer makes a gap of so many periods.
    SILENCE_MS = 250,
    SILENCE_PERIODS = 4,
    MENDING_PERIOD_S = 1,
    // Half the FIFO: the other half covers the time until the main loop comes.
    BATCH_BYTES = GLP_MPU_FIFO_BYTES / 2,
    BATCH_SAMPLES = GLP_BOARD_INSTANTS / 4,
    // The last quarter of the queue is for instants that come while the main loop reads the others.
    INSTANTS_TRUSTED = GLP_BOARD_INSTANTS / 4 * 3,
    EMPTYING_ATTEMPTS = 8
};

#define INSTANT_MASK (GLP_BOARD_INSTANTS - 1U)
_Static_assert((GLP_BOARD_INSTANTS & INSTANT_MASK) == 0U, "GLP_BOARD_INSTANTS must be a power of two");
_Static_assert(GLP_BOARD_RING_MIN >= GLP_FRAME_WIRE_MAX + 2U + SHORT_FRAMES_RESERVE, "ring too small");

// ---------------------------------------------------------------------------------------------------- time

static uint64_t now_ticks(const glp_board* self) {
    return self->hal->ticks(self->hal->context) & self->tick_mask;
}

static uint64_t elapsed(const glp_board* self, uint64_t from, uint64_t to) {
    return (to - from) & self->tick_mask;
}

static uint64_t instant_at(const glp_board* self, uint32_t instant) {
    return self->instant_ticks[instant & INSTANT_MASK];
}

static uint32_t instants_pending(const glp_board* self) { return self->instants - self->instants_done; }

void glp_board_on_sampling_instant(glp_board* self, uint64_t ticks) {
    if (!self->armed) { return; }
    const uint32_t instant = self->instants;
    self->instant_ticks[instant & INSTANT_MASK] = ticks & self->tick_mask;
    self->instants = instant + 1U;
}

void glp_board_on_data_ready(glp_board* self, uint64_t ticks) {
    if (self->interrupts_to_skip > 0U) {
        self->interrupts_to_skip = (uint16_t)(self->interrupts_to_skip - 1U);
        return;
    }
    self->interrupts_to_skip = (uint16_t)(self->plan.decimation - 1U);
    glp_board_on_sampling_instant(self, ticks);
}

// -------------------------------------------------------------------------------------------------- frames

static bool send(glp_board* self, glp_frame_type type, uint16_t flags, const uint8_t* payload, size_t size) {
    const glp_frame frame = {(uint8_t)type, flags, self->sequence, payload, size};
    ++self->sequence;
    const glp_cobs_result encoded = glp_frame_encode(&frame, self->wire, sizeof self->wire);
    const size_t reserve = (type == glp_frame_samples) ? SHORT_FRAMES_RESERVE : 0U;
    if (glp_frame_ring_put(&self->ring, self->wire, encoded.size, reserve)) { return true; }
    ++self->lost_frames;
    ++self->untold_frames;
    self->next_flags |= glp_flag_ring_overflow;
    return false;
}

static void send_hello(glp_board* self) {
    glp_hello hello = {.protocol_major = GLP_PROTOCOL_MAJOR,
                       .protocol_minor = GLP_PROTOCOL_MINOR,
                       .tick_bits = self->identity.tick_bits,
                       .who_am_i = self->who_am_i,
                       .tick_hz = self->identity.tick_hz,
                       .boot_id = self->identity.boot_id,
                       .reset_cause = (uint8_t)self->identity.reset_cause};
    memcpy(hello.uid, self->identity.uid, sizeof hello.uid);
    const char* firmware = self->identity.firmware;
    for (size_t i = 0; (i < GLP_FIRMWARE_BYTES) && (firmware[i] != '\0'); ++i) {
        hello.firmware[i] = firmware[i];
    }
    const char* known = glp_mpu_name(self->who_am_i);
    const char* sensor = (known != NULL) ? known : "not an MPU-9250";
    for (size_t i = 0; (i < GLP_SENSOR_BYTES) && (sensor[i] != '\0'); ++i) { hello.sensor[i] = sensor[i]; }
    uint8_t payload[128];
    const size_t size = glp_hello_write(&hello, payload, sizeof payload);
    send(self, glp_frame_hello, 0, payload, size);
}

static void send_config(glp_board* self) {
    uint8_t payload[64];
    const size_t size = glp_config_write(&self->config, payload, sizeof payload);
    send(self, glp_frame_config, 0, payload, size);
}

static void introduce(glp_board* self) {
    send_hello(self);
    send_config(self);
    self->hello_ticks = now_ticks(self);
}

static void send_status(glp_board* self) {
    const glp_hal* hal = self->hal;
    const glp_device_status status = {
        .ticks = now_ticks(self),
        .next_index = self->next_index + instants_pending(self),
        .lost_samples = self->lost_samples,
        .lost_frames = self->lost_frames,
        .ring_bytes = (uint32_t)self->ring.capacity,
        .ring_high_water_bytes = (uint32_t)self->ring.high_water,
        .usb_frame_number = (hal->usb_frame_number != NULL) ? hal->usb_frame_number(hal->context) : 0U,
        .fifo_overflows = self->fifo_overflows,
        .bus_errors = self->bus_errors,
        .temperature = self->temperature,
        .streaming = self->streaming ? 1U : 0U,
        .reset_cause = (uint8_t)self->identity.reset_cause};
    uint8_t payload[64];
    const size_t size = glp_device_status_write(&status, payload, sizeof payload);
    send(self, glp_frame_status, 0, payload, size);
}

static void send_event(glp_board* self, glp_event_code code, uint64_t index, uint32_t value,
                       const char* text) {
    glp_event event = {.ticks = now_ticks(self),
                       .index = index,
                       .code = (uint16_t)code,
                       .value = (value <= INT32_MAX) ? (int32_t)value : INT32_MAX,
                       .text = text};
    while ((event.text_bytes < GLP_EVENT_TEXT_MAX) && (text[event.text_bytes] != '\0')) {
        ++event.text_bytes;
    }
    uint8_t payload[128];
    const size_t size = glp_event_write(&event, payload, sizeof payload);
    send(self, glp_frame_event, 0, payload, size);
}

static void send_reply(glp_board* self, const glp_frame* command, glp_result result) {
    const glp_reply reply = {command->sequence, command->type, (uint8_t)result};
    uint8_t payload[16];
    const size_t size = glp_reply_write(&reply, payload, sizeof payload);
    send(self, glp_frame_reply, 0, payload, size);
}

// ------------------------------------------------------------------------------------------------- samples

static void read_temperature(glp_board* self) {
    uint8_t bytes[2];
    if (!self->hal->sensor_read(self->hal->context, glp_mpu_temp_out_h, bytes, sizeof bytes)) {
        ++self->bus_errors;
        return;
    }
    self->temperature = (int16_t)(uint16_t)(((unsigned)bytes[0] << 8U) | bytes[1]);
}

static void send_samples(glp_board* self) {
    if (self->frame_samples == 0U) { return; }
    glp_samples samples = {.first_ticks = self->frame_ticks,
                           .first_index = self->frame_index,
                           .config_generation = self->config.generation,
                           .lost_samples = self->lost_samples,
                           .count = self->frame_samples,
                           .layout = self->plan.layout,
                           .samples = self->payload + GLP_SAMPLES_HEADER_BYTES};
    if ((self->plan.layout & glp_layout_temperature) != 0) {
        self->temperature =
            glp_sample_field(&samples, samples.count - 1U, (size_t)self->plan.sample_bytes / 2U - 1U);
    } else if (self->plan.fifo) {
        read_temperature(self);
    }
    samples.temperature = self->temperature;
    const size_t size = glp_samples_write(&samples, self->payload, sizeof self->payload);
    self->frame_samples = 0;
    if (!send(self, glp_frame_samples, self->frame_flags, self->payload, size)) {
        self->lost_samples += samples.count;
        // What came before this frame comes before the next one, too.
        self->next_flags |= self->frame_flags & (uint16_t)~glp_flag_saturated;
    }
}

// Where the next sample of the frame that is being filled belongs.
static uint8_t* place_for_samples(glp_board* self) {
    return self->payload + GLP_SAMPLES_HEADER_BYTES + (size_t)self->frame_samples * self->plan.sample_bytes;
}

static void pass_instants(glp_board* self, uint32_t count) {
    self->previous_ticks = instant_at(self, self->instants_done + count - 1U);
    self->previous_known = true;
    self->heard_ticks = self->previous_ticks;
    self->instants_done += count;
    self->next_index += count;
}

static void count_samples(glp_board* self, uint32_t count, bool saturated) {
    if (self->frame_samples == 0U) {
        self->frame_ticks = instant_at(self, self->instants_done);
        self->frame_index = self->next_index;
        self->frame_flags = self->next_flags;
        self->next_flags = 0;
    }
    if (saturated) { self->frame_flags |= glp_flag_saturated; }
    pass_instants(self, count);
    self->frame_samples = (uint8_t)(self->frame_samples + count);
    if (self->frame_samples == self->config.samples_per_frame) { send_samples(self); }
}

// The oldest `count` instants have no sample. The frame before them ends here, so that its samples are
// consecutive.
static void lose_instants(glp_board* self, uint32_t count, uint16_t why) {
    send_samples(self);
    if (self->untold_flags == 0U) { self->untold_index = self->next_index; }
    self->untold_flags |= why;
    self->next_flags |= why;
    if (count == 0U) { return; }
    self->untold_samples += count;
    self->lost_samples += count;
    pass_instants(self, count);
}

// Instants that the rate calls for pass without an interrupt: their number is known, their ticks are those of
// the nominal rate.
static void lose_silence(glp_board* self, uint64_t count) {
    lose_instants(self, 0, glp_flag_data_ready_silent);
    self->heard_ticks = (self->heard_ticks + count * self->period_ticks) & self->tick_mask;
    self->previous_ticks = self->heard_ticks;
    self->previous_known = true;
    self->next_index += count;
    self->lost_samples += (uint32_t)count;
    self->untold_samples += (uint32_t)count;
}

// Up to the first interrupt that comes again.
static void end_silence(glp_board* self) {
    if (!self->silent || (instants_pending(self) == 0U)) { return; }
    self->silent = false;
    const uint64_t since = elapsed(self, self->heard_ticks, instant_at(self, self->instants_done));
    const uint64_t periods = (since + self->period_ticks / 2U) / self->period_ticks;
    if ((since <= self->tick_mask / 2U) && (periods > 1U)) { lose_silence(self, periods - 1U); }
}

// How many of the oldest `count` instants follow each other at about the nominal distance. Where the first
// one does not, the frame before it ends and the next one is flagged.
static uint32_t even_run(glp_board* self, uint32_t count) {
    if (self->period_ticks < 8U) { return count; }  // the timer is too coarse to tell
    const uint64_t longest = self->period_ticks + self->period_ticks / 2U;
    const uint64_t shortest = self->period_ticks / 2U;
    uint64_t previous = self->previous_ticks;
    for (uint32_t i = 0; i < count; ++i) {
        const uint64_t ticks = instant_at(self, self->instants_done + i);
        const uint64_t distance = elapsed(self, previous, ticks);
        previous = ticks;
        if ((distance <= longest) && (distance >= shortest)) { continue; }
        if (i > 0U) { return i; }
        if (self->previous_known) {
            send_samples(self);
            self->next_flags |= glp_flag_time_discontinuity;
        }
    }
    return count;
}

// --------------------------------------------------------------------------------------------- sensor's FIFO

// Empties the FIFO at a moment between two interrupts, so that FIFO and instants agree again.
static bool empty_fifo(glp_board* self, uint32_t* instants) {
    for (int attempt = 0; attempt < EMPTYING_ATTEMPTS; ++attempt) {
        *instants = self->instants;
        if (!glp_mpu_fifo_empty(self->hal)) {
            ++self->bus_errors;
            return false;
        }
        if (self->instants != *instants) { continue; }
        if (glp_mpu_overflow_clear(self->hal)) { return true; }
        ++self->bus_errors;
        return false;
    }
    return false;
}

static void resynchronise(glp_board* self, uint16_t why) {
    self->resync = true;
    self->resync_flags |= why;
    uint32_t instants = 0;
    if (!empty_fifo(self, &instants)) { return; }  // the next turn tries again
    lose_instants(self, instants - self->instants_done, self->resync_flags);
    self->resync = false;
    self->resync_flags = 0;
}

// Instants that the FIFO has samples for but whose interrupt never came: their ticks are unknown, their
// number is not.
static void count_missed_interrupts(glp_board* self, uint32_t count) {
    lose_instants(self, 0, glp_flag_time_discontinuity);
    self->next_index += count;
    self->lost_samples += count;
    self->untold_samples += count;
}

static void take_records(glp_board* self, uint32_t records) {
    while (records > 0U) {
        const uint32_t room = (uint32_t)self->config.samples_per_frame - self->frame_samples;
        const uint32_t run = even_run(self, (records < room) ? records : room);
        uint8_t* place = place_for_samples(self);
        if (!self->hal->sensor_read(self->hal->context, glp_mpu_fifo_r_w, place,
                                    (size_t)run * self->plan.sample_bytes)) {
            ++self->bus_errors;
            resynchronise(self, glp_flag_bus_error);  // how far the burst got is unknown
            return;
        }
        count_samples(self, run, glp_mpu_arrange(place, run, self->plan.layout));
        records -= run;
    }
}

// False where the bus failed: nothing is lost yet.
static bool count_fifo_records(glp_board* self, uint32_t* records, bool* overflowed) {
    size_t bytes = 0;
    if (!glp_mpu_fifo_level(self->hal, &bytes, overflowed)) {
        ++self->bus_errors;
        return false;
    }
    *records = (uint32_t)bytes / self->plan.sample_bytes;
    return true;
}

static void read_fifo(glp_board* self) {
    const uint32_t pending_before = instants_pending(self);
    uint32_t records = 0;
    bool overflowed = false;
    if (!count_fifo_records(self, &records, &overflowed)) { return; }
    const uint32_t pending_after = instants_pending(self);
    if (overflowed || (pending_after > INSTANTS_TRUSTED)) {
        ++self->fifo_overflows;
        resynchronise(self, glp_flag_sensor_fifo_overflow);
    } else if (records > pending_after) {
        // The count was latched before pending_after was read: every interrupt of these records is long over.
        count_missed_interrupts(self, records - pending_after);
        resynchronise(self, glp_flag_time_discontinuity);
    } else if (pending_before > records + 1U) {
        // The interrupt may run ahead of the FIFO by the sample that is just being written, but not by more.
        resynchronise(self, glp_flag_time_discontinuity);
    } else {
        take_records(self, records);
    }
}

static bool worth_reading(const glp_board* self, uint64_t now, uint32_t pending) {
    uint32_t wanted = (uint32_t)self->config.samples_per_frame - self->frame_samples;
    const uint32_t batch = BATCH_BYTES / (uint32_t)self->plan.sample_bytes;
    if (wanted > batch) { wanted = batch; }
    if (wanted > BATCH_SAMPLES) { wanted = BATCH_SAMPLES; }
    if (pending >= wanted) { return true; }
    const uint64_t oldest =
        (self->frame_samples > 0U) ? self->frame_ticks : instant_at(self, self->instants_done);
    return elapsed(self, oldest, now) >= self->patience_ticks;
}

// ---------------------------------------------------------------------------------------- data registers

// The registers hold the newest sample only. It is taken for the newest instant while at most a quarter of a
// period has passed since; a later one would carry a wrong time.
static void read_registers(glp_board* self) {
    const uint32_t pending = instants_pending(self);
    const uint64_t late =
        elapsed(self, instant_at(self, self->instants_done + pending - 1U), now_ticks(self));
    const uint32_t missed = (late > self->period_ticks / 4U) ? pending : pending - 1U;
    if (missed > 0U) {
        ++self->fifo_overflows;
        lose_instants(self, missed, glp_flag_sensor_fifo_overflow);
        if (missed == pending) { return; }
    }
    uint8_t all[GLP_MPU_ALL_BYTES];
    if (!self->hal->sensor_read(self->hal->context, glp_mpu_accel_xout_h, all, sizeof all)) {
        ++self->bus_errors;
        lose_instants(self, 1, glp_flag_bus_error);
        return;
    }
    even_run(self, 1);
    uint8_t* place = place_for_samples(self);
    uint8_t* end = place;
    const uint8_t layout = self->plan.layout;
    self->temperature = (int16_t)(uint16_t)(((unsigned)all[6] << 8U) | all[7]);
    if ((layout & glp_layout_accel) != 0) {
        memcpy(end, all, 6);
        end += 6;
    }
    if ((layout & glp_layout_temperature) != 0) {
        memcpy(end, all + 6, 2);
        end += 2;
    }
    if ((layout & glp_layout_gyro) != 0) { memcpy(end, all + 8, 6); }
    count_samples(self, 1, glp_mpu_arrange(place, 1, layout));
}

static void take_samples(glp_board* self, uint64_t now) {
    const uint32_t pending = instants_pending(self);
    if (self->resync) {
        // Without a new instant the bus has no reason to have recovered.
        if (pending > 0U) { resynchronise(self, 0); }
    } else if (pending > 0U) {
        if (!self->plan.fifo) {
            read_registers(self);
        } else if (worth_reading(self, now, pending)) {
            read_fifo(self);
        }
    }
    if ((self->frame_samples > 0U) && (elapsed(self, self->frame_ticks, now) >= self->patience_ticks)) {
        send_samples(self);
    }
}

// ------------------------------------------------------------------------------------------ start and stop

// Kept until the host has been told who is speaking: it may discard what comes before a HELLO.
static bool note_setup(glp_board* self, glp_mpu_outcome outcome, glp_mpu_fault fault) {
    self->setup_outcome = outcome;
    self->setup_fault = fault;
    self->sensor_ready = outcome == glp_mpu_ok;
    if (outcome == glp_mpu_bus_error) { ++self->bus_errors; }
    return self->sensor_ready;
}

static void tell_setup(glp_board* self) {
    const uint32_t value = ((uint32_t)self->setup_fault.address << 8U) | self->setup_fault.value;
    if (self->setup_outcome == glp_mpu_bus_error) {
        send_event(self, glp_event_bus_error, self->next_index, 0, "");
    } else if (self->setup_outcome == glp_mpu_fault_found) {
        send_event(self, glp_event_sensor_fault, self->next_index, value, "");
    }
    self->setup_outcome = glp_mpu_ok;
}

static void tell_start(glp_board* self) {
    tell_setup(self);
    if (self->streaming) { send_event(self, glp_event_started, 0, 0, ""); }
}

static void choose_samples_per_frame(glp_board* self) {
    const uint32_t fit = (uint32_t)glp_samples_per_frame_max(self->plan.layout);
    uint32_t count = self->samples_per_frame_asked;
    if (count == 0U) {
        const uint32_t span_uHz = 1000000U / FRAME_SPAN_MS;  // rate in mHz over this is samples in the span
        count = (self->settings.rate_mHz + span_uHz / 2U) / span_uHz;
        if (count == 0U) { count = 1; }
        if (count > fit) { count = fit; }
    }
    self->config.samples_per_frame = (uint8_t)count;
}

static void adopt(glp_board* self, const glp_mpu_settings* settings, const glp_mpu_plan* plan) {
    self->settings = *settings;
    self->plan = *plan;
    glp_mpu_describe(settings, plan, &self->config);
    choose_samples_per_frame(self);
    self->period_ticks = (uint64_t)self->identity.tick_hz * 1000U / settings->rate_mHz;
    self->silence_ticks = (uint64_t)self->identity.tick_hz * SILENCE_MS / 1000U;
    if (self->silence_ticks < SILENCE_PERIODS * self->period_ticks) {
        self->silence_ticks = SILENCE_PERIODS * self->period_ticks;
    }
}

// Writes the plan into the sensor; from a hardware reset on if the sensor's state is in doubt.
static bool prepare_sensor(glp_board* self) {
    glp_mpu_fault fault = {0, 0};
    glp_mpu_outcome outcome = glp_mpu_ok;
    if (!self->sensor_ready) { outcome = glp_mpu_reset(self->hal, &self->who_am_i, &fault); }
    if (outcome == glp_mpu_ok) {
        outcome = glp_mpu_apply(self->hal, &self->plan, self->config.registers, &fault);
    }
    return note_setup(self, outcome, fault);
}

static void clear_accounts(glp_board* self) {
    self->next_index = 0;
    self->previous_known = false;
    self->lost_samples = 0;
    self->lost_frames = 0;
    self->fifo_overflows = 0;
    self->bus_errors = 0;
    self->resync = false;
    self->resync_flags = 0;
    self->next_flags = glp_flag_first_after_start;
    self->untold_flags = 0;
    self->untold_samples = 0;
    self->untold_frames = 0;
    self->frame_samples = 0;
    self->ring.high_water = self->ring.used;
}

// The interrupt and the FIFO on, the FIFO empty.
static bool start_sensor(glp_board* self) {
    self->interrupts_to_skip = 0;
    self->armed = true;
    uint32_t instants = self->instants;
    glp_mpu_fault fault = {0, 0};
    glp_mpu_outcome outcome = glp_mpu_start(self->hal, &self->plan, self->config.registers, &fault);
    if ((outcome == glp_mpu_ok) && self->plan.fifo && !empty_fifo(self, &instants)) {
        outcome = glp_mpu_bus_error;
    }
    if (outcome != glp_mpu_ok) {
        self->armed = false;
        return note_setup(self, outcome, fault);
    }
    self->instants_done = instants;
    return true;
}

static bool start(glp_board* self) {
    if (!self->sensor_ready && !prepare_sensor(self)) { return false; }
    clear_accounts(self);
    if (!start_sensor(self)) {
        // It has forgotten its set-up since: the host is told, and the stream starts under a new one.
        const glp_mpu_outcome found = self->setup_outcome;
        const glp_mpu_fault fault = self->setup_fault;
        if ((found != glp_mpu_fault_found) || !prepare_sensor(self) || !start_sensor(self)) { return false; }
        self->setup_outcome = found;
        self->setup_fault = fault;
    }
    read_temperature(self);
    self->streaming = true;
    self->status_ticks = now_ticks(self);
    self->heard_ticks = self->status_ticks;
    self->silent = false;
    self->mended_ticks = self->status_ticks - (uint64_t)self->identity.tick_hz * MENDING_PERIOD_S;
    self->told_ticks = self->status_ticks - self->patience_ticks;
    return true;
}

// No instant joins any more, but the FIFO fills on: of its records as many are taken as there are instants.
static void take_last_records(glp_board* self) {
    const uint32_t pending = instants_pending(self);
    uint32_t records = 0;
    bool overflowed = false;
    if (!count_fifo_records(self, &records, &overflowed)) { return; }
    if (overflowed || (pending > INSTANTS_TRUSTED)) {
        ++self->fifo_overflows;
        lose_instants(self, pending, glp_flag_sensor_fifo_overflow);
    } else if (pending > records + 1U) {
        lose_instants(self, pending, glp_flag_time_discontinuity);
    } else {
        take_records(self, (records < pending) ? records : pending);
    }
}

static void stop(glp_board* self) {
    if (!self->streaming) { return; }
    // First: what the sensor samples while its FIFO is read for the last time is not of this stream.
    self->armed = false;
    const bool readable = self->plan.fifo && !self->resync;
    // Once more where the interrupt ran ahead of the FIFO by a sample.
    for (int reads = 0; readable && (reads < 2) && (instants_pending(self) > 0U); ++reads) {
        take_last_records(self);
    }
    send_samples(self);
    // What the FIFO could not give any more was sampled all the same.
    const uint32_t pending = instants_pending(self);
    if (pending > 0U) { lose_instants(self, pending, 0); }
    if (self->silent) {
        lose_silence(self, elapsed(self, self->heard_ticks, now_ticks(self)) / self->period_ticks);
    }
    self->streaming = false;
    if (glp_mpu_stop(self->hal) != glp_mpu_ok) {
        ++self->bus_errors;
        self->sensor_ready = false;  // the next start sets it up afresh
    }
    send_event(self, glp_event_stopped, self->next_index, self->lost_samples, "");
}

void glp_board_on_line_state(glp_board* self, bool dtr) {
    if (dtr == self->dtr) { return; }
    self->dtr = dtr;
    if (!dtr) {
        stop(self);
        return;
    }
    self->armed = false;
    self->streaming = false;
    glp_frame_ring_drop_waiting(&self->ring);
    glp_stream_init(&self->commands);
    start(self);
    introduce(self);
    tell_start(self);
}

// ----------------------------------------------------------------------------------------- a silent sensor

// A sensor that was reset or lost its power sends no interrupts, and its registers show it. Where they are
// right, the line or the sensing element is dead, which nothing here can mend.
static void mend_sensor(glp_board* self) {
    self->mended_ticks = now_ticks(self);
    glp_mpu_fault fault = {0, 0};
    const glp_mpu_outcome found = glp_mpu_check(self->hal, &self->plan, self->config.registers, &fault);
    if (note_setup(self, found, fault)) { return; }
    tell_setup(self);
    self->armed = false;
    if (!prepare_sensor(self) || !start_sensor(self)) { tell_setup(self); }
}

static void watch_data_ready(glp_board* self) {
    const uint32_t pending = instants_pending(self);
    const uint64_t last = (pending > 0U) ? instant_at(self, self->instants - 1U) : self->heard_ticks;
    const uint64_t silent = elapsed(self, last, now_ticks(self));
    // An interrupt that came after the clock was read lies ahead of it.
    if ((silent <= self->silence_ticks) || (silent > self->tick_mask / 2U) || (self->period_ticks == 0U)) {
        return;
    }
    if (pending > 0U) { lose_instants(self, pending, glp_flag_data_ready_silent); }
    if (elapsed(self, self->mended_ticks, now_ticks(self)) >=
        (uint64_t)self->identity.tick_hz * MENDING_PERIOD_S) {
        mend_sensor(self);
    }
    self->silent = true;
    lose_silence(self, elapsed(self, self->heard_ticks, now_ticks(self)) / self->period_ticks);
    // What the FIFO may have taken meanwhile is of those instants.
    self->resync = self->plan.fifo;
}

// ------------------------------------------------------------------------------------------------- commands

static glp_result configure(glp_board* self, const glp_configure* asked) {
    glp_mpu_settings settings = self->settings;
    if (asked->rate_mHz != 0U) { settings.rate_mHz = asked->rate_mHz; }
    if (asked->gyro_full_scale_dps != 0U) { settings.gyro_full_scale_dps = asked->gyro_full_scale_dps; }
    if (asked->accel_full_scale_g != 0U) { settings.accel_full_scale_g = asked->accel_full_scale_g; }
    if (asked->dlpf_hz != 0U) { settings.dlpf_hz = asked->dlpf_hz; }
    if (asked->layout != 0U) { settings.layout = asked->layout; }
    glp_mpu_plan plan;
    const uint32_t rate_max_mHz = self->identity.rate_max_mHz;
    if (!glp_mpu_plan_for(&settings, &plan) || ((rate_max_mHz != 0U) && (settings.rate_mHz > rate_max_mHz)) ||
        (asked->samples_per_frame > glp_samples_per_frame_max(settings.layout))) {
        return glp_result_bad_value;
    }
    stop(self);
    self->samples_per_frame_asked = asked->samples_per_frame;
    ++self->config.generation;
    adopt(self, &settings, &plan);
    return prepare_sensor(self) ? glp_result_ok : glp_result_sensor_fault;
}

static void on_configure(glp_board* self, const glp_frame* command) {
    glp_configure asked;
    const glp_status status = glp_configure_read(command, &asked);
    if (status != glp_status_ok) {
        send_reply(self, command,
                   (status == glp_status_bad_length) ? glp_result_bad_length : glp_result_bad_value);
        return;
    }
    const bool was_streaming = self->streaming;
    glp_result result = configure(self, &asked);
    if (result == glp_result_bad_value) {
        send_reply(self, command, result);
        return;
    }
    if ((result == glp_result_ok) && was_streaming && !start(self)) { result = glp_result_sensor_fault; }
    send_reply(self, command, result);
    send_config(self);
    tell_start(self);
}

static void on_start(glp_board* self, const glp_frame* command) {
    if (self->streaming) {
        send_reply(self, command, glp_result_ok);
        return;
    }
    const bool started = start(self);
    send_reply(self, command, started ? glp_result_ok : glp_result_sensor_fault);
    introduce(self);
    tell_start(self);
}

static void on_command(glp_board* self, const glp_frame* command) {
    switch (command->type) {
        case glp_frame_get_hello:
            send_reply(self, command, glp_result_ok);
            introduce(self);
            tell_setup(self);
            break;
        case glp_frame_configure:
            on_configure(self, command);
            break;
        case glp_frame_start:
            on_start(self, command);
            break;
        case glp_frame_stop:
            stop(self);
            send_reply(self, command, glp_result_ok);
            break;
        case glp_frame_get_status:
            send_reply(self, command, glp_result_ok);
            send_status(self);
            break;
        default:
            // A frame of the device's own kind is an echo, not a command.
            if (command->type >= 0x80U) { send_reply(self, command, glp_result_unknown_command); }
            break;
    }
}

void glp_board_on_receive(glp_board* self, const uint8_t* bytes, size_t size) {
    while (size > 0U) {
        glp_frame command;
        bool have_command = false;
        const size_t taken = glp_stream_push(&self->commands, bytes, size, &command, &have_command);
        bytes += taken;
        size -= taken;
        if (have_command) { on_command(self, &command); }
    }
}

// ------------------------------------------------------------------------------------------------ main loop

static void tell_losses(glp_board* self, uint64_t now) {
    // At most one EVENT in PATIENCE_MS: a fault that lasts must not fill the link with its reports.
    if ((self->untold_flags != 0U) && (elapsed(self, self->told_ticks, now) >= self->patience_ticks)) {
        const uint16_t why = self->untold_flags;
        const uint32_t lost = self->untold_samples;
        self->untold_flags = 0;
        self->untold_samples = 0;
        self->told_ticks = now;
        if ((why & glp_flag_sensor_fifo_overflow) != 0) {
            send_event(self, glp_event_sensor_fifo_overflow, self->untold_index, lost, "");
        } else if ((why & glp_flag_bus_error) != 0) {
            send_event(self, glp_event_bus_error, self->untold_index, lost, "");
        } else if ((why & glp_flag_data_ready_silent) != 0) {
            send_event(self, glp_event_data_ready_silent, self->untold_index, lost, "");
        } else {
            send_event(self, glp_event_text, self->untold_index, lost,
                       "data-ready interrupts and FIFO disagreed");
        }
    }
    // Told once there is room again, not with every frame that a ring at its brim refuses.
    if ((self->untold_frames > 0U) && (self->ring.used <= self->ring.capacity / 2U)) {
        const uint32_t frames = self->untold_frames;
        self->untold_frames = 0;
        send_event(self, glp_event_ring_overflow, self->next_index, frames, "");
    }
}

// True once a period has passed since `*last`, which then moves on by whole periods as long as it keeps up.
static bool due(const glp_board* self, uint64_t* last, uint64_t now, uint32_t period_s) {
    const uint64_t period_ticks = (uint64_t)self->identity.tick_hz * period_s;
    const uint64_t since = elapsed(self, *last, now);
    if (since < period_ticks) { return false; }
    *last = (since < 2U * period_ticks) ? ((*last + period_ticks) & self->tick_mask) : now;
    return true;
}

void glp_board_poll(glp_board* self) {
    if (self->streaming) {
        const uint64_t now = now_ticks(self);
        end_silence(self);
        take_samples(self, now);
        watch_data_ready(self);
        if (due(self, &self->hello_ticks, now, HELLO_PERIOD_S)) {
            send_hello(self);
            send_config(self);
        }
        if (due(self, &self->status_ticks, now, STATUS_PERIOD_S)) { send_status(self); }
        tell_losses(self, now);
    }
    glp_frame_ring_feed(&self->ring, self->hal);
}

bool glp_board_init(glp_board* self, const glp_hal* hal, const glp_board_identity* identity, uint8_t* ring,
                    size_t ring_bytes) {
    if ((ring_bytes < GLP_BOARD_RING_MIN) || (identity->tick_bits < 32U) || (identity->tick_bits > 64U) ||
        (identity->tick_hz == 0U)) {
        return false;
    }
    const uint64_t tick_mask =
        (identity->tick_bits == 64U) ? UINT64_MAX : (((uint64_t)1U << identity->tick_bits) - 1U);
    if (tick_mask / 10U < identity->tick_hz) { return false; }
    memset(self, 0, sizeof *self);
    self->hal = hal;
    self->identity = *identity;
    self->tick_mask = tick_mask;
    self->patience_ticks = (uint64_t)identity->tick_hz * PATIENCE_MS / 1000U;
    glp_frame_ring_init(&self->ring, ring, ring_bytes);
    glp_stream_init(&self->commands);

    const glp_mpu_settings settings = {.rate_mHz = 100000,
                                       .gyro_full_scale_dps = 500,
                                       .accel_full_scale_g = 8,
                                       .dlpf_hz = 41,
                                       .layout = glp_layout_gyro | glp_layout_accel};
    glp_mpu_plan plan;
    const bool known = glp_mpu_plan_for(&settings, &plan);
    if (known) { adopt(self, &settings, &plan); }
    return known;
}

bool glp_board_boot(glp_board* self) { return prepare_sensor(self); }
