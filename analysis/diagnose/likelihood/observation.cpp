#include "analysis/diagnose/likelihood/observation.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/likelihood/hole_filling.hpp"
#include "analysis/diagnose/likelihood/lag_course.hpp"
#include "analysis/diagnose/likelihood/stand_ins.hpp"
#include "analysis/diagnose/likelihood/white_share.hpp"
#include "analysis/numerics/cosine_transform.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/known_motion.hpp"
#include "analysis/simulate/random_purpose.hpp"

namespace gyrolog::resolution {

// Coefficients. Their mean square tells the power of slow noise to a quarter, sqrt(2 / 32) of a normal
// variable's.
constexpr double level_coefficients = 32.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Calls take(slot, row) for every row on the grid.
template <typename Take>
void for_each_slot(const std::vector<Segment>& segments, std::int64_t origin, std::size_t length, Take take) {
    for (const Segment& segment : segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            const auto slot = static_cast<std::size_t>(segment.first_index - origin) + i;
            if (slot >= length) { return; }
            take(slot, segment.first + i);
        }
    }
}

std::vector<bool> judged_rows(const Recording& recording, const SensorModel& model) {
    std::vector<bool> judged(recording.rows(), true);
    for (const EffectModel& entry : model.effects) {
        const EffectSignature* signature = find_effect(entry.effect)->signature;
        if (signature == nullptr || signature->unjudged == nullptr) { continue; }
        signature->unjudged(recording, entry, judged);
    }
    return judged;
}

// Where the rows belong on the grid: where their stamps have them, or where the motion has them if the model
// knows of losses that the stamps hide.
std::vector<Segment> placed_rows(const Prediction& prediction, const Recording& recording) {
    const bool hidden = std::ranges::any_of(prediction.model().effects, [](const EffectModel& entry) {
        const EffectSignature* signature = find_effect(entry.effect)->signature;
        return signature != nullptr && signature->hides_losses != nullptr &&
               signature->hides_losses(EffectValues(entry));
    });
    if (!hidden || !prediction.moves()) { return recording.segments; }
    const std::int64_t origin = prediction.world().recording().segments.front().first_index;
    std::vector<Segment> placed;
    std::int64_t late = 0;
    const std::vector<LagStep> steps = LagCourse(prediction, recording).steps();
    auto step = steps.begin();
    for (Segment segment : recording.segments) {
        for (; step != steps.end(); ++step) {
            const std::int64_t before = origin + static_cast<std::int64_t>(step->slot) - segment.first_index;
            if (before >= static_cast<std::int64_t>(segment.count)) { break; }
            const std::size_t count = before > 0 ? static_cast<std::size_t>(before) : 0;
            if (count > 0) { placed.push_back({segment.first, count, segment.first_index + late}); }
            segment = {segment.first + count, segment.count - count,
                       segment.first_index + static_cast<std::int64_t>(count)};
            late += step->samples;
        }
        placed.push_back({segment.first, segment.count, segment.first_index + late});
    }
    return placed;
}

// With the model's white noise on it.
void draw_first_guesses(const Prediction& prediction, std::size_t axis, std::vector<float>& values,
                        const std::vector<bool>& present, std::uint64_t seed) {
    const double sd = std::sqrt(prediction.parts(axis).back().sum() * prediction.rate_hz());
    const RandomStream noise = derived_stream(seed, RandomPurpose::stand_ins, axis);
    join_holes(values, present, [&](std::size_t slot) { return sd * noise.normal(slot); });
}

// Moves the parameters of the model's uncertain responses to their most likely values under the density; what
// is left has other products and another power.
void give_way(const Prediction& prediction, std::size_t axis, AxisObservation& seen) {
    const UncertainMean& uncertain = prediction.uncertain(axis);
    const BinSums weights = bin_weights(seen.density, prediction.rate_hz());
    const std::vector<double> step = uncertain.step(weights, seen.uncertain_products, seen.uncertain_fit);
    BinSums change(weights.size(), 0.0);
    for (std::size_t u = 0; u < uncertain.size(); ++u) {
        seen.uncertain_fit[u] += step[u];
        add_multiple(change, -2.0 * step[u], seen.uncertain_products[u]);
        for (std::size_t v = 0; v < uncertain.size(); ++v) {
            add_multiple(change, step[u] * step[v], uncertain.products(u, v));
        }
    }
    for (std::size_t u = 0; u < uncertain.size(); ++u) {
        for (std::size_t v = 0; v < uncertain.size(); ++v) {
            add_multiple(seen.uncertain_products[u], -step[v], uncertain.products(u, v));
        }
    }
    for (std::size_t i = 0; i < seen.power.size(); ++i) {
        const double by = change[i] / (prediction.bins()[i].count() * prediction.rate_hz());
        seen.power[i] = std::max(0.0, seen.power[i] + by);
    }
}

void take_off(const UncertainMean& uncertain, const std::vector<double>& fit, std::vector<float>& cosines) {
    for (std::size_t u = 0; u < uncertain.size(); ++u) {
        const std::vector<float>& response = uncertain[u].cosines;
        const auto by = static_cast<float>(fit[u]);
        for (std::size_t k = 1; k < response.size(); ++k) { cosines[k] -= by * response[k]; }
    }
}

// The mean power of the bins around this one, as few as have level_coefficients.
double power_around(const SpectralBins& bins, const std::vector<double>& power, std::size_t bin) {
    double sum = bins[bin].count() * power[bin];
    double count = bins[bin].count();
    const auto take = [&](std::size_t other) {
        sum += bins[other].count() * power[other];
        count += bins[other].count();
    };
    for (std::size_t reach = 1; reach < bins.size() && count < resolution::level_coefficients; ++reach) {
        if (bin + reach < bins.size()) { take(bin + reach); }
        if (reach <= bin) { take(bin - reach); }
    }
    return sum / count;
}

// The noise that was fitted; at rest, where the recording has more slow noise, that. Expected without it,
// stand-ins would be outliers beside a drift that no cause explains yet. Where the sensor moves, a slow
// residual may be an answer to the motion that the model has wrong, does not go on in a hole as noise does,
// and is no noise to fit: then the model's, by which a response is filled in, too (hole_filling.hpp).
std::vector<double> density_of_expectation(const Prediction& prediction, std::size_t axis,
                                           const AxisObservation& seen) {
    if (prediction.moves()) { return density_of_model(prediction, axis); }
    std::vector<double> density = seen.density;
    const SpectralBins& bins = prediction.bins();
    const double slow_hz = 0.5 * prediction.rate_hz() / static_cast<double>(resolution::stand_in_lags);
    for (std::size_t i = 0; i < bins.size() && bins[i].f_hz < slow_hz; ++i) {
        density[i] = std::max(density[i], power_around(bins, seen.power, i));
    }
    return density;
}

// Draws what stands in for missing samples, given the samples.
void fill_holes(const Prediction& prediction, std::size_t axis, AxisObservation& seen,
                const std::vector<std::size_t>& missing, CosineTransform& transform, std::uint64_t seed) {
    std::vector<float> cosines = seen.cosines;
    take_off(prediction.uncertain(axis), seen.uncertain_fit, cosines);
    const std::vector<double> density = density_of_expectation(prediction, axis, seen);
    const std::vector<double> weighted = weighted_values(prediction, density, cosines, transform);
    const InverseCovariance scatter = inverse_covariance_of(prediction, seen.density);
    const RandomStream noise = derived_stream(seed, RandomPurpose::stand_ins, axis);
    // Where the sensor moves the expectation is the model's.
    const std::shared_ptr<const ExpectedStandIns>& holes = prediction.holes(axis);
    if (holes && holes->slots() == missing) {
        holes->expect(seen.residual_rad_s, weighted);
        scatter_stand_ins(seen.residual_rad_s, missing, scatter, noise);
        return;
    }
    draw_stand_ins(seen.residual_rad_s, missing, weighted, inverse_covariance_of(prediction, density),
                   scatter, noise);
}

// White noise whose level the model has go with time has the same variance throughout afterwards.
void even_out(const Prediction& prediction, std::size_t axis, std::vector<float>& whitened) {
    const std::vector<float>& course = prediction.white_course(axis);
    if (course.empty()) { return; }
    const double share = white_share(prediction, axis).variance;
    for (std::size_t slot = 0; slot < whitened.size(); ++slot) {
        const double variance = 1.0 + share * (static_cast<double>(course[slot]) - 1.0);
        whitened[slot] = static_cast<float>(static_cast<double>(whitened[slot]) / std::sqrt(variance));
    }
}

void measure_power(const SpectralBins& bins, double rate_hz, const std::vector<float>& cosines,
                   std::vector<double>& power) {
    power.resize(bins.size());
    for (std::size_t i = 0; i < bins.size(); ++i) {
        double sum = 0.0;
        for (std::size_t k = bins[i].first; k < bins[i].end; ++k) {
            const auto coefficient = static_cast<double>(cosines[k]);
            if (bins[i].has(k)) { sum += coefficient * coefficient; }
        }
        power[i] = sum / (bins[i].count() * rate_hz);
    }
}

}  // namespace

Observation::Observation(std::shared_ptr<const Prediction> prediction,
                         std::shared_ptr<const Recording> recording, std::uint64_t seed,
                         ReferenceNoise reference_noise)
    : Observation(std::move(prediction), std::move(recording), seed, reference_noise, nullptr) {}

Observation::Observation(std::shared_ptr<const Prediction> prediction, const Observation& completed)
    : Observation(std::move(prediction), completed.recording_, completed.seed_, completed.reference_noise_,
                  &completed) {}

Observation::Observation(std::shared_ptr<const Prediction> prediction,
                         std::shared_ptr<const Recording> recording, std::uint64_t seed,
                         ReferenceNoise reference_noise, const Observation* completed)
    : prediction_(std::move(prediction)),
      recording_(std::move(recording)),
      seed_(seed),
      reference_noise_(reference_noise),
      segments_(placed_rows(*prediction_, *recording_)) {
    const std::size_t length = prediction_->length();
    const std::int64_t origin = prediction_->world().recording().segments.front().first_index;
    present_.assign(length, false);
    const std::vector<bool> judged = judged_rows(*recording_, prediction_->model());
    for_each_slot(segments_, origin, length,
                  [&](std::size_t slot, std::size_t row) { present_[slot] = judged[row]; });
    for (std::size_t slot = 0; slot < length; ++slot) {
        if (!present_[slot]) { missing_.push_back(slot); }
    }
    const TransformPool::Lease transform = prediction_->transform();
    if (completed != nullptr && !can_be_completed_by(*completed)) { completed = nullptr; }
    for (const std::size_t axis : prediction_->axes()) { observe(axis, completed, *transform); }
    // What moved before the recording began is not known, and a sensor that lags shows it.
    const double unknown_s = prediction_->moves() ? KnownMotionOptions{}.memory_s : 0.0;
    for (std::size_t slot = 0; slot < length; ++slot) {
        const bool known = static_cast<double>(slot) >= unknown_s * prediction_->rate_hz();
        present_[slot] = present_[slot] && known && has_slot(prediction_->half(), slot, length);
    }
}

bool Observation::can_be_completed_by(const Observation& other) const {
    return !prediction_->moves() && std::ranges::includes(other.missing_, missing_);
}

// As numbers of the recording: the two models may expect others.
void Observation::copy_stand_ins(const Observation& from, std::size_t axis,
                                 std::vector<float>& residual_rad_s) const {
    const std::vector<float>& theirs = from.prediction_->response_rad_s(axis);
    const std::vector<float>& ours = prediction_->response_rad_s(axis);
    const AxisObservation& other = from.axes_[axis];
    const auto mean = static_cast<float>(other.mean_rad_s - axes_[axis].mean_rad_s);
    for (const std::size_t slot : missing_) {
        residual_rad_s[slot] = other.residual_rad_s[slot] + theirs[slot] - ours[slot] + mean;
    }
}

double Observation::drawn_clock_rel() const {
    if (reference_noise_ == ReferenceNoise::recorded || !prediction_->moves()) { return 0.0; }
    return clock_rate_sd_rel(prediction_->model()) *
           derived_stream(seed_, RandomPurpose::replicate_clock).normal(0);
}

void Observation::take_expected_off(std::size_t axis, std::vector<float>& residual_rad_s) const {
    const bool drawn = reference_noise_ == ReferenceNoise::drawn;
    const std::vector<float>& expected =
        drawn ? prediction_->denoised_response_rad_s(axis) : prediction_->response_rad_s(axis);
    const double drawn_sd_rad_s = drawn ? prediction_->reference_noise_rad_s(axis) : 0.0;
    const RandomStream noise = derived_stream(seed_, RandomPurpose::replicate_reference_noise, axis);
    const double clock_rel = drawn_clock_rel();
    const std::vector<float>& change_rad_s2 = prediction_->response_change_rad_s2(axis);
    const Column& column = *recording_->find(gyro_columns[axis]);
    const std::int64_t origin = prediction_->world().recording().segments.front().first_index;
    for_each_slot(segments_, origin, residual_rad_s.size(), [&](std::size_t slot, std::size_t row) {
        double residual = column.value(row) - static_cast<double>(expected[slot]);
        if (clock_rel != 0.0) {
            const double ahead_s = clock_rel * static_cast<double>(slot) / prediction_->rate_hz();
            residual += ahead_s * static_cast<double>(change_rad_s2[slot]);
        }
        if (drawn_sd_rad_s > 0.0) { residual -= drawn_sd_rad_s * noise.normal(slot); }
        residual_rad_s[slot] = static_cast<float>(residual);
    });
}

// The noise, and how far the uncertain responses give way.
void Observation::fit_model(std::size_t axis, CosineTransform& transform) {
    const Prediction& prediction = *prediction_;
    AxisObservation& seen = axes_[axis];
    std::vector<double> work(seen.residual_rad_s.begin(), seen.residual_rad_s.end());
    transform.forward(work);
    work[0] = 0.0;
    seen.cosines.assign(work.begin(), work.end());
    measure_power(prediction.bins(), prediction.rate_hz(), seen.cosines, seen.power);
    const std::array<double, 3> sd_rel = noise_uncertainty(prediction.model(), axis);
    seen.density.resize(prediction.bins().size());
    const auto fit_noise = [&] {
        seen.noise = fit_nuisance(prediction.bins(), prediction.parts(axis), seen.power, sd_rel, seen.noise);
        expected_density(prediction.parts(axis), sd_rel, seen.noise.z, seen.density);
    };
    fit_noise();
    const UncertainMean& uncertain = prediction.uncertain(axis);
    if (uncertain.empty()) { return; }
    seen.uncertain_products = uncertain.products_with(prediction.bins(), seen.cosines);
    seen.uncertain_fit.assign(uncertain.size(), 0.0);
    // What they explain was noise to the first fit.
    for (int round = 0; round < 3; ++round) {
        give_way(prediction, axis, seen);
        fit_noise();
    }
}

void Observation::observe(std::size_t axis, const Observation* completed, CosineTransform& transform) {
    const Prediction& prediction = *prediction_;
    const std::size_t length = prediction.length();
    AxisObservation& seen = axes_[axis];
    std::vector<float>& residual = seen.residual_rad_s;
    residual.assign(length, 0.0F);
    take_expected_off(axis, residual);
    seen.mean_rad_s = take_mean_off(residual, present_);
    const UncertainMean& uncertain = prediction.uncertain(axis);
    if (completed != nullptr) {
        copy_stand_ins(*completed, axis, residual);
    } else if (!missing_.empty()) {
        draw_first_guesses(prediction, axis, residual, present_, seed_);
    }
    fit_model(axis, transform);
    // What stands in for a sample has noise like that which was fitted.
    const bool is_filled = missing_.empty() || completed != nullptr;
    const int rounds = is_filled ? 0 : filling_rounds(prediction, axis);
    for (int round = 0; round < rounds; ++round) {
        fill_holes(prediction, axis, seen, missing_, transform, seed_);
        fit_model(axis, transform);
    }
    if (!uncertain.empty()) {
        take_off(uncertain, seen.uncertain_fit, seen.cosines);
        std::vector<double> work(seen.cosines.begin(), seen.cosines.end());
        transform.inverse(work);
        residual.assign(work.begin(), work.end());
    }
    seen.whitened = seen.cosines;
    divide_by_bin(prediction, seen.density, seen.whitened,
                  [](double variance) { return std::sqrt(variance); });
    transform.inverse(std::span<float>(seen.whitened));
    even_out(prediction, axis, seen.whitened);
}

double stand_ins_nats(const Observation& observation, std::size_t axis) {
    if (observation.missing().empty()) { return 0.0; }
    const Prediction& prediction = observation.prediction();
    const AxisObservation& seen = observation.axis(axis);
    const TransformPool::Lease transform = prediction.transform();
    return stand_ins_log_density_nats(observation.missing(),
                                      weighted_values(prediction, seen.density, seen.cosines, *transform),
                                      inverse_covariance_of(prediction, seen.density));
}

double log_likelihood_nats(const Observation& observation) {
    double nats = 0.0;
    for (const std::size_t axis : observation.prediction().axes()) {
        nats += observation.axis(axis).noise.log_likelihood_nats - stand_ins_nats(observation, axis) -
                uncertain_charge_nats(observation, axis);
    }
    return nats;
}

double uncertain_charge_nats(const Observation& observation, std::size_t axis) {
    const UncertainMean& uncertain = observation.prediction().uncertain(axis);
    double charge = 0.0;
    for (std::size_t u = 0; u < uncertain.size(); ++u) {
        const double z = observation.axis(axis).uncertain_fit[u] / uncertain[u].sd;
        charge += 0.5 * z * z;
    }
    return charge;
}

}  // namespace gyrolog
