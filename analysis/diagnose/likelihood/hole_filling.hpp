// What stands in the slots of a prediction's grid that have no sample, so that a likelihood of spectra can
// take all slots: in an observation, numbers such as the samples and the noise have them (stand_ins.hpp); in
// a mean response, what is expected of it there given its values at the samples. Both are the same linear
// function of the values at the samples, so that a regression of the one on the other is that of the samples
// alone. A response that ended at every hole would be one that no observation has.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/likelihood/stand_ins.hpp"

namespace gyrolog {

namespace resolution {

// Stand-ins farther apart tell nothing of each other. Behind a filter of 5 Hz at 100 Hz the weight there is
// 1e-12 of the nearest one's, beside flicker noise 2e-3.
inline constexpr std::size_t stand_in_lags = 64;
// A stand-in is expected once more after the model's uncertain responses have given way to the samples.
inline constexpr int rounds_beside_uncertain = 2;

}  // namespace resolution

class CosineTransform;

// The function sets the values where nothing is present: straight lines between the levels on either side of
// each hole, and what `beside` adds to the line in a slot.
void join_holes(std::vector<float>& values, const std::vector<bool>& present,
                const std::function<double(std::size_t slot)>& beside);

// The function takes the mean of the values that are present off these, and returns it.
double take_mean_off(std::vector<float>& values, const std::vector<bool>& present);

// The function divides the coefficients by divisor_of(the variance that noise of the density gives them).
template <typename Values, typename Divisor>
void divide_by_bin(const Prediction& prediction, const std::vector<double>& density, Values& cosines,
                   Divisor divisor_of) {
    const SpectralBins& bins = prediction.bins();
    cosines[0] = 0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const double divisor = divisor_of(density[i] * prediction.rate_hz());
        // Coefficients of which the half has no bin go with the next one's.
        const std::size_t first = i == 0 ? 1 : bins[i - 1].end;
        const std::size_t end = i + 1 == bins.size() ? cosines.size() : bins[i].end;
        for (std::size_t k = first; k < end; ++k) {
            cosines[k] = static_cast<typename Values::value_type>(static_cast<double>(cosines[k]) / divisor);
        }
    }
}

// How often what stands in a hole is taken from what stands around it. What stands in for a sample follows
// the motion as the samples do, so far as the model's uncertain responses have given way to it. A long hole
// keeps part of the straight line, which is why an observation and a response need the same number.
int filling_rounds(const Prediction& prediction, std::size_t axis);

// By bin, two-sided, in (rad/s)^2/Hz, of the model as it is.
std::vector<double> density_of_model(const Prediction& prediction, std::size_t axis);

// The function returns the product of the inverse of the noise's covariance with the values whose
// coefficients these are, by slot.
std::vector<double> weighted_values(const Prediction& prediction, const std::vector<double>& density,
                                    std::span<const float> cosines, CosineTransform& transform);

InverseCovariance inverse_covariance_of(const Prediction& prediction, const std::vector<double>& density);

// The function returns the cosine coefficients of a mean response on the axis, about its mean. `values`: by
// slot; where the sensor moves, those in the holes of the recording do not matter. Where it rests they stay
// as they are: what answers to nothing but time and temperature hardly changes over a hole.
std::vector<float> response_cosines(const Prediction& prediction, std::size_t axis,
                                    std::vector<double> values, CosineTransform& transform);
// While the prediction's uncertain responses are made, filling_rounds() does not know of them yet.
std::vector<float> response_cosines(const Prediction& prediction, std::size_t axis,
                                    std::vector<double> values, CosineTransform& transform, int rounds);

}  // namespace gyrolog
