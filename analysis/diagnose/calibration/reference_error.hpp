// The reference error is what a reference says wrongly about the motion. Where no model states it, it is read
// from the recording that is to be judged by the reference.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "analysis/diagnose/report.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// The model whose noise is that of the samples about the reference, by axis: white noise with a density and a
// course over time of its own beside the model's B and K, read from what is left of the rows when any gains
// and one latency are taken off, by generalised least squares. So it holds the sensor's noise as well, and
// nothing is known of either alone.
struct WithReferenceError {
    SensorModel model;
    ReferenceQuality quality;
};

// `rows` has a reference rate, and no diagnosis_refusal().
WithReferenceError with_reference_error(SensorModel model, const std::shared_ptr<const Recording>& rows,
                                        std::uint64_t seed);

// What the rows tell of a reference rate whose noise is known by axis, and is the model's.
ReferenceQuality quality_of_rates(const SensorModel& model, const std::shared_ptr<const Recording>& rows,
                                  const std::array<double, 3>& noise_rad_s, std::uint64_t seed);

}  // namespace gyrolog
