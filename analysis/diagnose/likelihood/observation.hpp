// An observation is one recording, real or simulated, against a prediction: what is left of it when the
// model's noise-free answer is taken off, in the form that likelihoods need.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "analysis/diagnose/likelihood/noise_nuisance.hpp"
#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

class CosineTransform;

struct AxisObservation {
    // The residual by slot, about its mean. Slots without a sample hold what stands in for one: its
    // expectation given the samples, and noise of the model about that.
    std::vector<float> residual_rad_s;
    std::vector<float> cosines;               // DCT-II of the residual, Y_0 = 0; rad/s
    double mean_rad_s = 0.0;                  // that was taken off
    std::vector<double> uncertain_fit;        // values of Prediction::uncertain() that were taken off
    std::vector<BinSums> uncertain_products;  // of the coefficients with its responses
    std::vector<double> power;    // by bin: mean square of the coefficients, over the rate: a density
    NoiseNuisance noise;          // the model's coefficients, fitted within their uncertainty
    std::vector<double> density;  // by bin: expected under `noise`
    // The whitened samples by slot, the inverse transform of Y_k / sqrt(S rate): standard normal and
    // independent where the model is right.
    std::vector<float> whitened;
};

class Observation {
public:
    // Every sample's expectation has the reference's noise in it: as it was recorded, or, of a replicate,
    // which is simulated in the denoised world, drawn from `seed`, or as it was measured anew. A replicate
    // that moves has a clock of its own, drawn from `seed` within the model's uncertainty: as the prediction
    // has it, to first order.
    enum class ReferenceNoise { recorded, drawn, measured_anew };

    // `recording` covers the prediction's grid: it is the prediction's own or a simulation like it. `seed`
    // draws what stands in holes.
    Observation(std::shared_ptr<const Prediction> prediction, std::shared_ptr<const Recording> recording,
                std::uint64_t seed, ReferenceNoise reference_noise = ReferenceNoise::recorded);
    // Of the same recording as `completed`, with the numbers that fill the holes there. Its model explains
    // more: what a model without a filter would draw is too loud where the filter leaves little noise. Where
    // the sensor moves, or `completed` has a sample in one of the holes, the holes are filled with draws.
    Observation(std::shared_ptr<const Prediction> prediction, const Observation& completed);

    // The same recording, with the same draws, under another model for the same world.
    Observation under(const SensorModel& model) const {
        return {prediction_->with(model), recording_, seed_, reference_noise_};
    }

    const Prediction& prediction() const { return *prediction_; }
    const Recording& recording() const { return *recording_; }
    // `axis` is one that the prediction has.
    const AxisObservation& axis(std::size_t axis) const { return axes_[axis]; }
    // By slot: a sample was there, is to be judged and belongs to the prediction's half.
    const std::vector<bool>& present() const { return present_; }
    // The slots where something stands in for a sample.
    const std::vector<std::size_t>& missing() const { return missing_; }

private:
    Observation(std::shared_ptr<const Prediction> prediction, std::shared_ptr<const Recording> recording,
                std::uint64_t seed, ReferenceNoise reference_noise, const Observation* completed);
    bool can_be_completed_by(const Observation& other) const;
    void copy_stand_ins(const Observation& from, std::size_t axis, std::vector<float>& residual_rad_s) const;
    // `completed` may be null.
    void observe(std::size_t axis, const Observation* completed, CosineTransform& transform);
    void fit_model(std::size_t axis, CosineTransform& transform);
    double drawn_clock_rel() const;
    void take_expected_off(std::size_t axis, std::vector<float>& residual_rad_s) const;

    std::shared_ptr<const Prediction> prediction_;
    std::shared_ptr<const Recording> recording_;
    std::uint64_t seed_;
    ReferenceNoise reference_noise_;
    std::vector<Segment> segments_;  // where its rows belong on the grid
    std::vector<bool> present_;
    std::vector<std::size_t> missing_;
    std::array<AxisObservation, 3> axes_;
};

// The function returns Whittle's log-likelihood of the samples, summed over the axes, with the priors of all
// that was fitted, in nats and without constants. Of samples y and stand-ins z it is log p(y) = log p(y, z) -
// log p(z | y).
double log_likelihood_nats(const Observation& observation);
// The function returns the logarithm of the density that the model gives the stand-ins, given the samples.
double stand_ins_nats(const Observation& observation, std::size_t axis);
// The function returns what the priors of the model's uncertain responses charge for the values they were
// fitted at.
double uncertain_charge_nats(const Observation& observation, std::size_t axis);

}  // namespace gyrolog
