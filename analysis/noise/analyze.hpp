// The whole Allan analysis of a recording: every axis of its gyro and of its accelerometer, from samples to
// coefficients.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/noise/gravity.hpp"
#include "analysis/noise/noise_fit.hpp"
#include "analysis/noise/outliers.hpp"
#include "analysis/noise/sensor_unit.hpp"
#include "analysis/noise/slope_reading.hpp"
#include "analysis/noise/static_bias.hpp"
#include "analysis/noise/temperature_drift.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/spectrum/power_spectrum.hpp"
#include "analysis/spectrum/spectral_lines.hpp"

namespace gyrolog {

struct AxisReport {
    std::string axis;  // "x", or "x2" of an array's second gyro
    StaticBias bias;   // an accelerometer's has gravity in it
    AllanCurve curve;
    NoiseFit fit;
    SlopeReading slopes;
    PowerSpectrum spectrum;
    std::vector<SpectralLine> lines;              // strongest first
    OutlierCount outliers;                        // with AnalysisOptions::robust
    std::optional<TemperatureDrift> temperature;  // where the recording has a temperature that varies
};

struct AccelerometerReport {
    SensorUnit unit = SensorUnit::g();  // g, unless the recording's text was in m/s^2 or in counts
    std::vector<AxisReport> axes;
    struct UnitGravity {
        std::string unit;  // "", or "2" of an array's second accelerometer
        Gravity gravity;
    };
    std::vector<UnitGravity> gravity;  // of each unit that has three axes
};

struct AnalysisReport {
    std::string name;
    double rate_hz = 0.0;
    std::optional<double> rate_sd_hz;
    std::optional<double> nominal_rate_hz;
    StampKind stamps = StampKind::none;
    double duration_s = 0.0;
    std::size_t samples = 0;
    std::size_t dropouts = 0;
    std::int64_t samples_missing = 0;
    std::size_t stops = 0;  // by the user: neither dropouts nor missing
    double stopped_s = 0.0;
    std::size_t segments = 0;
    DeviationKind kind = DeviationKind::overlapping;
    PhaseConvention convention = PhaseConvention::sp1065;
    double confidence = 0.683;
    RateUnit unit;  // dps, unless the recording's text was in rad/s or in counts without a scale
    std::vector<AxisReport> axes;  // the gyro's
    std::optional<AccelerometerReport> accelerometer;
    std::vector<std::string> warnings;

    bool has_axes() const { return !axes.empty() || accelerometer.has_value(); }
    // Of any axis of either sensor, which are on one board: NoiseFit::is_of_motion().
    bool is_of_motion() const;
};

struct AnalysisOptions : AllanOptions {
    Sensors sensors = Sensors::all;
    bool robust = false;  // replace outliers first (outliers.hpp); a warning says how many
    // Of a bias that follows the temperature (temperature_drift.hpp). Unless kept it is taken off the samples
    // first, where it is there beyond chance; a warning says so. The mean stays.
    bool keep_temperature = false;
    TemperatureDriftOptions temperature{};
};

// What the deviation's kind, convention and factors select is the curve that is shown: coefficients come from
// the samples by likelihood (likelihood_fit.hpp), slopes and starting values from the overlapping curve at
// the usual factors.
//
// Rows in which an accelerometer column has no value are missing to the accelerometer. A recording without a
// column of the sensors wanted, or with fewer than two samples, gives a report without axes and a warning.
AnalysisReport analyze(const Recording& recording, const AnalysisOptions& options = {});

}  // namespace gyrolog
