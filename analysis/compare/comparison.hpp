// A recording against a model's simulations of it, or against another recording, axis by axis.
//
// A simulation follows the recording: its time stamps and holes, its temperature, its reference motion
// (RecordedWorld), with a sensor drawn within the model's stated uncertainties (model_draw.hpp). What lies
// outside the band of the simulations is seen here and not explained, and no calibrated p-value is given;
// what is said to stand out does so on some axis of a recording without a gap with probability 5 % at most.
//
// In a recording with a reference rate, curves are of the gyro less the reference, in which the sensor's
// faults are not hidden by the motion; where the reference is not known, its last value is held. Both sides
// are treated alike.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/compare/axis_curves.hpp"
#include "analysis/compare/compared_curve.hpp"
#include "analysis/compare/compared_number.hpp"
#include "analysis/noise/sensor_unit.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct AxisComparison {
    std::string axis;
    ComparedCurve allan;     // by tau_s, unit of the rates
    ComparedCurve spectrum;  // by f_hz: root of the two-sided density, in the unit of the rates over sqrt(Hz)
    ComparedNumber standard_deviation, skewness, excess_kurtosis;
    // The recording itself, and one simulation or the other recording.
    AmplitudeHistogram recording_histogram, other_histogram;
    BlockAverages recording_averages, other_averages;

    // The larger of the two that stands out, if one does.
    const ComparedCurve* worst() const;
    // Likewise of the distribution's numbers; the standard deviation, which the curves also show, after the
    // shape.
    const ComparedNumber* worst_number() const;
};

struct Comparison {
    std::string recording_name;
    std::string other_name;
    double rate_hz = 0.0;  // of the recording
    double duration_s = 0.0;
    std::size_t samples = 0;
    double other_duration_s = 0.0;  // of the other recording; 0 with simulations, which are as long
    bool less_reference = false;
    SensorUnit unit = SensorUnit::dps();  // of the sensor's numbers, for readers
    std::size_t simulations = 0;          // 0: with a recording
    double band_probability = 0.0;
    std::uint64_t seed = 0;
    std::vector<AxisComparison> axes;
    std::vector<std::string> notes;  // on the model
    std::vector<std::string> warnings;
};

struct ModelComparisonOptions {
    std::size_t simulations = 40;
    std::uint64_t seed = 1;
    unsigned threads = 0;  // 0: all processors; the result is the same bits for any number
    // Called after each simulation with how many are done, by one thread at a time; false ends the work.
    std::function<bool(std::size_t)> on_progress{};
};

inline constexpr std::size_t simulations_min = 9;
inline constexpr std::size_t comparable_samples_min = 64;

// Why a recording cannot be compared: no axis x, y or z, counts without a scale, too short. Empty when it
// can.
std::optional<std::string> comparison_refusal(const Recording& recording);

// `model` has no simulation_refusal(), `recording` no comparison_refusal(). No value when ended early.
std::optional<Comparison> compare_with_model(std::shared_ptr<const Recording> recording,
                                             const SensorModel& model, const std::string& model_name,
                                             const ModelComparisonOptions& options = {});

// Over the axes that both have.
Comparison compare_recordings(const Recording& recording, const Recording& other, unsigned threads = 0);

}  // namespace gyrolog
