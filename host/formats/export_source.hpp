// What the export formats write: a recording with its analysis, or a sensor model. SI units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/noise/analyze.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct ExportedTerm {
    bool identified = false;
    double value = 0.0;           // 0 unless identified
    std::optional<double> upper;  // what a term that is not identified may be at most
};

struct ExportedAxis {
    std::string name;  // "x"
    ExportedTerm N;    // rad/s/sqrt(Hz), two-sided density
    ExportedTerm B;    // rad/s
    ExportedTerm K;    // rad/s*sqrt(Hz) = rad/s^2/sqrt(Hz)
    double bias = 0.0;
    std::optional<double> flat_tau_s;  // where the Allan curve is flat, if it is
};

struct ExportSource {
    std::string name;  // of the recording or model
    double rate_hz = 0.0;
    double confidence = 0.683;                // of the upper limits
    std::vector<ExportedAxis> gyro;           // x, y and z, as far as there are
    std::vector<ExportedAxis> accelerometer;  // in m/s^2 in place of rad/s
    bool accelerometer_has_counts = false;    // then it is not here, for want of a scale
    std::optional<double> full_scale_rad_s;
    std::optional<double> lsb_rad_s;
    std::optional<double> lsb_m_s2;
    std::optional<TemperatureModel> temperature;
    std::vector<std::string> effects;  // of a model, each a name with its sensor
    double inflate = 1.0;              // for filters: what their deviations and densities are multiplied by
    // For filters: the upper limit in the place of a number that is not identified.
    bool upper_limits = false;
    const Recording* recording = nullptr;  // absent of a model
    const AnalysisReport* report = nullptr;

    const ExportedAxis* gyro_axis(std::string_view axis) const;
};

// Both must outlive the answer. Of an array's gyros the first on each axis counts.
ExportSource export_source(const Recording& recording, const AnalysisReport& report);
ExportSource export_source(const SensorModel& model, const std::string& name);

// Those of the analysis; none of a model.
std::vector<std::string> warnings_of(const ExportSource& source);

// The largest of the axes' values, and whether any is identified: for formats that have one number for all
// axes, so that no axis is trusted too much.
ExportedTerm largest(const std::vector<ExportedAxis>& axes, ExportedTerm ExportedAxis::*term);

}  // namespace gyrolog
