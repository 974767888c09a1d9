// What one axis of a recording looks like: in time, in amplitude, by averaging time, by frequency.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/amplitude/amplitude_histogram.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/spectrum/power_spectrum.hpp"

namespace gyrolog {

// Averages over blocks of equal length about the mean of all. Blocks without a sample are NaN.
struct BlockAverages {
    double block_s = 0.0;
    std::vector<double> rate;  // block i begins at i block_s from the first sample

    double middle_s(std::size_t block) const { return (static_cast<double>(block) + 0.5) * block_s; }
};

BlockAverages block_averages(const Column& column, std::span<const Segment> segments, double rate_hz,
                             std::size_t blocks);

// Fine enough that a line stands out from the band that holds it.
inline constexpr int spectrum_points_per_decade = 100;

// Of the column's values, in its unit.
struct AxisCurves {
    AllanCurve allan;  // overlapping
    PowerSpectrum spectrum;
    AmplitudeHistogram histogram;
    BlockAverages averages;
};

struct AxisCurvesOptions {
    std::vector<std::int64_t> m{};  // averaging factors; empty: the usual ones
    bool intervals = true;          // of the Allan deviation
    std::size_t blocks = 400;       // of the averages; 0: none
    unsigned threads = 1;
};

AxisCurves axis_curves(const Column& column, std::span<const Segment> segments, double rate_hz,
                       const AxisCurvesOptions& options = {});

// y at `at`, between the points of rising x: straight on logarithmic axes. NaN outside of them, and where one
// of the two is not positive.
double interpolated(std::span<const double> x, std::span<const double> y, double at);

}  // namespace gyrolog
