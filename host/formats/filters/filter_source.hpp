// What a filter's file is written from: white noise N and random walk K of both sensors, each the largest of
// its axes, as a model or an analysis has them. SI units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/noise/noise_fit.hpp"
#include "analysis/noise/sensor_unit.hpp"
#include "host/formats/export_source.hpp"

namespace gyrolog {

struct FilterTerm {
    std::optional<double> value;  // absent: not identified, or none
    bool is_upper = false;        // the value is an upper limit (ExportSource::upper_limits)
    std::optional<double> upper;  // what it may be at most where it is not identified
    std::string axes;             // "x 0.0001, y none, z < 2e-05"
    std::vector<ExportedAxis> of_axes;
};

struct FilterSource {
    std::string name;  // of the recording or model
    double rate_hz = 0.0;
    double confidence = 0.683;
    double inflate = 1.0;  // is in all values
    bool has_accelerometer = false;
    bool accelerometer_has_counts = false;
    bool has_converter_step = false;  // N has the error of the converter's step in it
    FilterTerm gyro_N;
    FilterTerm gyro_K;
    FilterTerm accelerometer_N;
    FilterTerm accelerometer_K;
    std::vector<std::string> advice;  // what no filter's numbers have, each a sentence

    // Of N or K.
    const FilterTerm& term(SensorKind sensor, NoiseTerm term) const;
};

// The step's error is white noise of variance step^2 / 12 a sample, which fits and models keep apart from N:
// a filter has no other place for it.
FilterSource filter_source(const ExportSource& source);

}  // namespace gyrolog
