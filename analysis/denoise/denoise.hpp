// A recording of one gyro or an array, denoised: what is known of the units from a part at rest, the filter
// over all samples, and what it achieved.
//
// The filter itself is causal (array_denoiser.hpp). What it is told of the units' noise may come from any
// part of the recording, or from another one, as a calibration would.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/denoise/array_columns.hpp"
#include "analysis/denoise/array_denoiser.hpp"
#include "analysis/denoise/bandwidth_curve.hpp"
#include "analysis/denoise/motion_error.hpp"
#include "analysis/denoise/unit_bands.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/recording/still_part.hpp"
#include "analysis/spectrum/power_spectrum.hpp"
#include "analysis/spectrum/spectral_lines.hpp"

namespace gyrolog {

// A unit at rest.
struct UnitKnowledge {
    std::string name;  // "1", or "" of a single gyro
    NoiseModel model;
    double variance = 0.0;            // of its samples
    std::vector<SpectralLine> lines;  // strongest first
    UnitLimits limits;
};

struct AxisKnowledge {
    std::string axis;
    std::vector<UnitKnowledge> units;
    ArrayNoise noise;
    std::vector<UnitBand> bands;
    std::vector<double> offsets;  // of the units about their mean
    // Where the correlations in `noise` come from: how many differences of the bands that one or the other
    // noise rules; 0: none, taken as independent.
    std::size_t white_differences = 0;
    std::size_t walk_differences = 0;
};

// Of a recording at rest: noise models as `analyze` fits them, unless they are given (one of each unit), and
// correlations. Correlation between units that is not beyond twice its chance deviation is taken for none.
// `axis` names and columns of `still`; the saturation is that of counts (the ends of 16 bits), or given.
std::vector<AxisKnowledge> learn_units(const Recording& still, std::optional<double> saturation);

// Of units that were not seen at rest, as far as their columns tell: for use_models(). Nothing is known of
// correlations and offsets, so that one unit an axis loses nothing by it.
std::vector<AxisKnowledge> know_units(const Recording& recording, std::optional<double> saturation);

// Puts the given models in place of the fitted ones: models[axis][unit].
void use_models(std::vector<AxisKnowledge>& axes, const std::vector<std::vector<NoiseModel>>& models);

// A stretch of samples in which a unit was left out.
struct UnitFailure {
    std::string unit;
    UnitState state = UnitState::good;
    double from_s = 0.0;  // from the recording's first sample
    double to_s = 0.0;
    std::size_t samples = 0;
};

struct DenoisedSignal {
    DenoiseDesign design;
    std::vector<double> rate;     // one a row
    double still_variance = 0.0;  // over the part at rest
    AllanCurve allan;             // likewise
    PowerSpectrum spectrum;
    FilterResponse response;            // of an adaptive rate: in motion
    FilterResponse calm;                // of an adaptive rate: what it tends to at rest; else as above
    std::optional<MotionError> motion;  // over all but the part at rest, where there is a reference
};

struct AxisDenoising {
    AxisKnowledge knowledge;
    std::vector<DenoisedSignal> signals;  // one of each design, in their order
    // Of the part at rest; empty where there is none in the recording itself.
    std::vector<double> unit_variances;
    double mean_variance = 0.0;  // of the units' plain mean
    std::vector<AllanCurve> unit_allan;
    std::vector<PowerSpectrum> unit_spectra;
    std::optional<MotionError> unit_motion;  // of the first unit
    std::vector<double> sample_weights;      // of the first design's filter
    std::vector<double> drift_weights;
    std::vector<UnitFailure> failures;  // of the first design; at most 1000, the rest only counted
    std::size_t failures_more = 0;
    std::vector<BandwidthPoint> trend_curve;  // what other bandwidths would do
    std::vector<BandwidthPoint> walk_curve;

    double unit_variance() const;  // the units' mean
};

struct DenoiseRequest {
    std::vector<DenoiseDesign> designs;  // the first one's rate is the result
    TimeSpan still;                      // in the recording; empty: none
    bool details = true;                 // false: the rates alone
    unsigned threads = 1;
};

// `knowledge` as learn_units() gives it for the same axes and units.
std::vector<AxisDenoising> denoise(const Recording& recording, std::vector<AxisKnowledge> knowledge,
                                   const DenoiseRequest& request);

// The recording with gx gy gz in place of its gyro columns; stamps and other columns as they are.
Recording denoised_recording(const Recording& recording, std::span<const AxisDenoising> axes);

}  // namespace gyrolog
