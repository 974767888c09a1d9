#include "host/sensor/gyrolog_sensor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <string>

#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/stepped_sensor.hpp"
#include "host/formats/model_json.hpp"

struct gyrolog_sensor {
    gyrolog::SteppedSensor simulated;
    std::array<double, 3> lsb_rad_s;
    // Taken, but not handed out: the caller had no room.
    std::optional<gyrolog::SteppedSample> waiting{};
};

namespace gyrolog {
namespace {

gyrolog_sensor_sample in_c(const SteppedSample& sample) {
    gyrolog_sensor_sample out{};
    out.index = sample.index;
    out.time_s = sample.stamp_s;
    std::ranges::copy(sample.rate_rad_s, out.rate_rad_s);
    out.temperature_C = sample.temperature_C;
    std::ranges::copy(sample.counts, out.counts);
    return out;
}

WorldInstant from_c(const gyrolog_sensor_input& now) {
    WorldInstant instant;
    instant.t_s = now.time_s;
    std::ranges::copy(now.rate_rad_s, instant.rate_rad_s.begin());
    std::ranges::copy(now.specific_force_m_s2, instant.specific_force_m_s2.begin());
    instant.temperature_C = now.temperature_C;
    return instant;
}

int status_of(SteppedSensor::Step step) {
    switch (step) {
        case SteppedSensor::Step::taken:
            return GYROLOG_SENSOR_OK;
        case SteppedSensor::Step::not_later:
            return GYROLOG_SENSOR_TIME;
        case SteppedSensor::Step::not_finite:
            return GYROLOG_SENSOR_NOT_FINITE;
        case SteppedSensor::Step::temperature_changed:
            return GYROLOG_SENSOR_TEMPERATURE;
    }
    return GYROLOG_SENSOR_BAD_ARGUMENT;
}

int hand_out(gyrolog_sensor& sensor, gyrolog_sensor_sample* samples, std::size_t room, std::size_t& count) {
    for (;;) {
        if (!sensor.waiting) {
            SteppedSample taken;
            switch (sensor.simulated.take(taken)) {
                case SteppedSensor::Take::none:
                    return GYROLOG_SENSOR_OK;
                case SteppedSensor::Take::forgotten:
                    return GYROLOG_SENSOR_STEPS_FORGOTTEN;
                case SteppedSensor::Take::sample:
                    sensor.waiting = taken;
            }
        }
        if (count == room) { return GYROLOG_SENSOR_MORE; }
        samples[count++] = in_c(*sensor.waiting);
        sensor.waiting.reset();
    }
}

// Null with the reason in `why`.
std::unique_ptr<gyrolog_sensor> opened(const char* path, std::uint64_t seed, double rate_hz,
                                       std::string& why) {
    const auto file = read_model_file(path, seed);
    if (!file.ok()) {
        why = file.error().message;
        return nullptr;
    }
    const SensorModel& model = file->model;
    if (const auto refusal = simulation_refusal(model)) {
        why = std::string(path) + ": " + *refusal;
        return nullptr;
    }
    if (file->unstated.rate && rate_hz == 0.0) {
        why = std::string(path) + ": rate_hz is missing: state it there, or give a rate";
        return nullptr;
    }
    const double used_hz = rate_hz == 0.0 ? model.rate_hz : rate_hz;
    if (!std::isfinite(used_hz) || used_hz <= 0.0) {
        why = "the rate is not above zero: give it in Hz, or 0 for the model's";
        return nullptr;
    }
    return std::make_unique<gyrolog_sensor>(
        gyrolog_sensor{SteppedSensor(model, used_hz, seed), converter_steps_rad_s(model)});
}

void copy_cut(const std::string& text, char* out, std::size_t size) {
    if (out == nullptr || size == 0) { return; }
    const std::size_t used = std::min(text.size(), size - 1);
    std::memcpy(out, text.data(), used);
    out[used] = '\0';
}

}  // namespace
}  // namespace gyrolog

gyrolog_sensor* gyrolog_sensor_open(const char* path, uint64_t seed, double rate_hz, char* why,
                                    size_t why_size) {
    std::string reason = "no path of a model";
    // The caller may be C, through which nothing can be thrown.
    try {
        if (path != nullptr) {
            if (auto sensor = gyrolog::opened(path, seed, rate_hz, reason)) { return sensor.release(); }
        }
    } catch (const std::exception& failure) { reason = failure.what(); }
    gyrolog::copy_cut(reason, why, why_size);
    return nullptr;
}

void gyrolog_sensor_close(gyrolog_sensor* sensor) { delete sensor; }

double gyrolog_sensor_rate_hz(const gyrolog_sensor* sensor) {
    return sensor == nullptr ? 0.0 : sensor->simulated.rate_hz();
}

double gyrolog_sensor_lsb_rad_s(const gyrolog_sensor* sensor, int axis) {
    return sensor == nullptr || axis < 0 || axis > 2 ? 0.0
                                                     : sensor->lsb_rad_s[static_cast<std::size_t>(axis)];
}

int gyrolog_sensor_step(gyrolog_sensor* sensor, const gyrolog_sensor_input* now,
                        gyrolog_sensor_sample* samples, size_t room, size_t* count) {
    if (sensor == nullptr || now == nullptr || count == nullptr || (samples == nullptr && room > 0)) {
        return GYROLOG_SENSOR_BAD_ARGUMENT;
    }
    *count = 0;
    const int stepped = gyrolog::status_of(sensor->simulated.step(gyrolog::from_c(*now)));
    return stepped == GYROLOG_SENSOR_OK ? gyrolog::hand_out(*sensor, samples, room, *count) : stepped;
}

int gyrolog_sensor_take(gyrolog_sensor* sensor, gyrolog_sensor_sample* samples, size_t room, size_t* count) {
    if (sensor == nullptr || count == nullptr || (samples == nullptr && room > 0)) {
        return GYROLOG_SENSOR_BAD_ARGUMENT;
    }
    *count = 0;
    return gyrolog::hand_out(*sensor, samples, room, *count);
}

const char* gyrolog_sensor_status_text(int status) {
    switch (status) {
        case GYROLOG_SENSOR_OK:
            return "all samples that are due were given";
        case GYROLOG_SENSOR_MORE:
            return "more samples are due than there was room for: take them";
        case GYROLOG_SENSOR_BAD_ARGUMENT:
            return "a null pointer was given";
        case GYROLOG_SENSOR_TIME:
            return "the time is not later than that of the step before";
        case GYROLOG_SENSOR_NOT_FINITE:
            return "an input is not finite";
        case GYROLOG_SENSOR_TEMPERATURE:
            return "the temperature is told in some steps and not in others";
        case GYROLOG_SENSOR_STEPS_FORGOTTEN:
            return "the sensor's delay is longer than the steps that it remembers: take samples more often, "
                   "or "
                   "make longer steps";
        default:
            return "no status of this library";
    }
}

const char* gyrolog_sensor_version() { return GYROLOG_SENSOR_VERSION; }
