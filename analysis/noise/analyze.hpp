// The whole Allan analysis of a recording: every gyro axis, from samples to coefficients.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/noise/noise_fit.hpp"
#include "analysis/noise/outliers.hpp"
#include "analysis/noise/slope_reading.hpp"
#include "analysis/noise/static_bias.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/spectrum/power_spectrum.hpp"
#include "analysis/spectrum/spectral_lines.hpp"

namespace gyrolog {

// The unit in which a rate is shown; everything in the report is in the columns' own (rad/s, or lsb without a
// scale).
struct RateUnit {
    std::string name = "dps";
    double per_column_unit = 1.0;
};

struct AxisReport {
    std::string axis;  // "x", or "x2" of an array's second gyro
    StaticBias bias;
    AllanCurve curve;
    NoiseFit fit;
    SlopeReading slopes;
    PowerSpectrum spectrum;
    std::vector<SpectralLine> lines;  // strongest first
    OutlierCount outliers;            // with AnalysisOptions::robust
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
    std::vector<AxisReport> axes;
    std::vector<std::string> warnings;
};

struct AnalysisOptions : AllanOptions {
    bool robust = false;  // replace outliers first (outliers.hpp); a warning says how many
};

// What the deviation's kind, convention and factors select is the curve that is shown: coefficients come from
// the samples by likelihood (likelihood_fit.hpp), slopes and starting values from the overlapping curve at
// the usual factors.
//
// A recording without a gyro column, or with fewer than two samples, gives a report without axes and a
// warning.
AnalysisReport analyze(const Recording& recording, const AnalysisOptions& options = {});

}  // namespace gyrolog
