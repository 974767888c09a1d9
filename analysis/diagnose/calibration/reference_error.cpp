#include "analysis/diagnose/calibration/reference_error.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/density_table.hpp"
#include "analysis/diagnose/likelihood/bin_sums.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog::resolution {

// Of the time: what is called the least and the most of an error that changes.
constexpr double quiet_share = 0.1;
constexpr int likelihood_steps = 200;
// Gains and delays that a fault of neither the sensor nor the reference may have: one sigma, so wide that the
// recording alone tells them. Sensors are off by 3 % and 2 % (PS-MPU-9250A-01 rev. 1.1, table 1), mountings
// by more; drivers and optical systems are late by some ms.
constexpr double open_gain_sd = 0.1;
constexpr double open_latency_sd_s = 0.05;
// Over which the error's level is read: it changes as the motion does.
constexpr double level_s = 2.0;

}  // namespace gyrolog::resolution

namespace gyrolog {
namespace {

// Its gains and its latency are as the recording has them.
SensorModel with_open_motion(SensorModel model) {
    model.sd_abs["M"] = resolution::open_gain_sd;
    model.sd_abs["latency_s"] = resolution::open_latency_sd_s;
    return model;
}

// White noise and the noise of an angle that is differentiated, as large as all that is left of an axis: the
// most likely two, by steps that raise Whittle's likelihood (C. Fevotte, N. Bertin, J.-L. Durrieu, Neural
// Computation 21 (2009) 793, equation 3.5 with two known spectra).
struct AngleAndWhite {
    double angle_rad2 = 0.0;
    double white_rad2_per_s = 0.0;
};

AngleAndWhite angle_and_white(const Prediction& prediction, const AxisObservation& seen) {
    const double rate_hz = prediction.rate_hz();
    const double white = 0.5 * mean_density(prediction.bins(), seen.power);
    AngleAndWhite noise{white / (2.0 * rate_hz), white};
    for (int step = 0; step < resolution::likelihood_steps; ++step) {
        AngleAndWhite more{0.0, 0.0};
        AngleAndWhite less{0.0, 0.0};
        for (std::size_t b = 0; b < prediction.bins().size(); ++b) {
            const double count = prediction.bins()[b].count();
            const double change_hz = 2.0 * rate_hz * std::sin(pi * prediction.bins()[b].f_hz / rate_hz);
            const double of_angle = change_hz * change_hz / rate_hz;
            const double density = noise.white_rad2_per_s + of_angle * noise.angle_rad2;
            more.white_rad2_per_s += count * seen.power[b] / (density * density);
            less.white_rad2_per_s += count / density;
            more.angle_rad2 += count * of_angle * seen.power[b] / (density * density);
            less.angle_rad2 += count * of_angle / density;
        }
        noise.white_rad2_per_s *= more.white_rad2_per_s / less.white_rad2_per_s;
        noise.angle_rad2 *= more.angle_rad2 / less.angle_rad2;
    }
    return noise;
}

// A filter that a person describes has a spectrum and changes the motion, too.
bool changes_noise_alone(const EffectModel& entry) {
    const EffectDefinition& effect = *find_effect(entry.effect);
    if (effect.make_timing != nullptr) { return false; }
    if (effect.noise_only || effect.signature == nullptr) { return effect.noise_only; }
    const EffectSignature& signature = *effect.signature;
    const bool is_filter = signature.changes_mean || signature.method == EvidenceMethod::described;
    return signature.white_gain != nullptr || signature.degrees_of_freedom != nullptr ||
           (signature.spectrum != nullptr && !is_filter);
}

enum class AngleNoise { none, as_seen };

// B and K of what is left, over the model's: of the judged gyro, and of the mean of others of its kind where
// these are the reference. Other references do not drift.
double drift_rel(const Recording& rows) {
    const auto gyros = static_cast<double>(rows.reference_gyros);
    return gyros > 0.0 ? std::sqrt(1.0 + 1.0 / gyros) : 1.0;
}

// Noise as large as all that is left, and the drift, which some densities at the lowest frequencies do not
// tell.
SensorModel with_noise_of(const Observation& left, SensorModel model, AngleNoise angle) {
    const double drift = drift_rel(left.recording());
    std::erase_if(model.effects, changes_noise_alone);
    for (const std::size_t axis : left.prediction().axes()) {
        AxisModel& of_axis = model.axes[axis];
        const NoiseCoefficients before = of_axis.noise;
        of_axis.noise = {};
        of_axis.noise.R_rad_per_s2 = before.R_rad_per_s2;
        of_axis.noise.B_rad_per_s = drift * before.B_rad_per_s;
        of_axis.noise.K_rad_per_s_sqrt_s = drift * before.K_rad_per_s_sqrt_s;
        std::erase_if(of_axis.sd_rel,
                      [](const auto& entry) { return entry.first == "N" || entry.first == "Q"; });
        const AngleAndWhite seen = angle_and_white(left.prediction(), left.axis(axis));
        const bool is_white = angle == AngleNoise::none;
        const double white_rad2_per_s =
            is_white ? mean_density(left.prediction().bins(), left.axis(axis).power) : seen.white_rad2_per_s;
        of_axis.noise.N_rad_per_sqrt_s = std::sqrt(white_rad2_per_s);
        if (!is_white) { of_axis.noise.Q_rad = std::sqrt(seen.angle_rad2); }
    }
    return model;
}

// The level of an axis' noise in blocks of equal length.
struct Levels {
    std::vector<double> level;  // root mean square over that of all; without samples that of the block before
    double evidence_nats = 0.0;  // against one level, in Schwarz's approximation (Ann. Stat. 6 (1978) 461)
};

Levels levels_of(const Observation& observation, std::size_t axis, std::size_t slots) {
    const std::vector<float>& whitened = observation.axis(axis).whitened;
    std::vector<double> sums(whitened.size() / slots + 1, 0.0);
    std::vector<double> counts(sums.size(), 0.0);
    double all = 0.0;
    double count = 0.0;
    for (std::size_t slot = 0; slot < whitened.size(); ++slot) {
        if (!observation.present()[slot]) { continue; }
        const double square = static_cast<double>(whitened[slot]) * static_cast<double>(whitened[slot]);
        sums[slot / slots] += square;
        counts[slot / slots] += 1.0;
        all += square;
        count += 1.0;
    }
    Levels levels;
    for (std::size_t block = 0; block < sums.size(); ++block) {
        const double before = levels.level.empty() ? 1.0 : levels.level.back();
        const bool is_known = sums[block] > 0.0 && counts[block] >= 0.5 * static_cast<double>(slots);
        levels.level.push_back(is_known ? std::sqrt(sums[block] / counts[block] * count / all) : before);
        if (!is_known) { continue; }
        levels.evidence_nats -= counts[block] * std::log(levels.level.back()) + 0.5 * std::log(count);
    }
    return levels;
}

EffectModel level_entry(const std::vector<double>& levels, std::size_t axis, double block_s) {
    EffectModel entry{"level_table", {axis_names.at(axis)}, {}, ""};
    for (const double level : levels) {
        const double middle = static_cast<double>(entry.table["t_s"].size()) + 0.5;
        entry.table["t_s"].push_back(middle * block_s);
        entry.table["factor"].push_back(level);
    }
    return entry;
}

// Of the values, the one that so large a share of them is below.
double quantile(std::vector<double> values, double share) {
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
}

// The mean over the axes, by what each tells of it.
void put_latency(const Observation& left, ReferenceQuality& quality) {
    const Prediction& prediction = left.prediction();
    double weights = 0.0;
    double sum = 0.0;
    for (const std::size_t axis : prediction.axes()) {
        const UncertainMean& uncertain = prediction.uncertain(axis);
        const std::size_t latency = prediction.axes().size();  // after the gains from each axis
        const double weight = weighted_sum(uncertain.products(latency, latency),
                                           bin_weights(left.axis(axis).density, prediction.rate_hz()));
        weights += weight;
        sum += weight * left.axis(axis).uncertain_fit[latency];
    }
    // The response is to the sensor being sooner.
    quality.latency_s = prediction.model().latency_s - sum / weights;
    quality.latency_sd_s = 1.0 / std::sqrt(weights);
}

// Of what the sensor shows the reference explains all but what is left. The reference's own error is in its
// rate and, the other way, in what is left: the sensor does not show it.
double bandwidth_hz(const Observation& left) {
    const Prediction& prediction = left.prediction();
    double bandwidth_hz = 0.0;
    for (const std::size_t axis : prediction.axes()) {
        const auto& axes = prediction.axes();
        const auto own = static_cast<std::size_t>(std::ranges::find(axes, axis) - axes.begin());
        const BinSums& moved = prediction.uncertain(axis).products(own, own);
        for (std::size_t b = 0; b < prediction.bins().size(); ++b) {
            const SpectralBin& bin = prediction.bins()[b];
            const double unexplained = bin.count() * left.axis(axis).power[b] * prediction.rate_hz();
            const double shown = moved[b] + 2.0 * left.axis(axis).uncertain_products[own][b] + unexplained;
            if (unexplained > definition::majority * shown) { continue; }
            bandwidth_hz = std::max(bandwidth_hz, 0.5 * prediction.rate_hz() * static_cast<double>(bin.end) /
                                                      static_cast<double>(prediction.length()));
        }
    }
    return bandwidth_hz;
}

// Reads the error from what is left of the rows.
class ErrorReader {
public:
    ErrorReader(std::shared_ptr<const Recording> rows, std::uint64_t seed)
        : rows_(std::move(rows)),
          seed_(seed),
          slots_(static_cast<std::size_t>(std::max(2.0, std::round(resolution::level_s * rows_->rate_hz)))) {}

    // What is left with this model, its gains and its latency as the recording has them.
    Observation left_by(const SensorModel& model) const {
        const auto world = std::make_shared<const RecordedWorld>(rows_);
        return {std::make_shared<const Prediction>(world, with_open_motion(model),
                                                   Prediction::NoiseOf::reference_too),
                rows_, seed_};
    }

    SensorModel with_density(SensorModel model, AngleNoise angle) const {
        const Observation all = left_by(model);
        model = with_noise_of(all, std::move(model), angle);
        const Observation left = left_by(model);
        const auto prediction = std::make_shared<const Prediction>(left.prediction());
        const auto density =
            make_density_table_estimator(*find_effect("density_table"), prediction).estimator->find(left);
        return density ? with_cause(std::move(model), *density) : model;
    }

    // The simulator has angle noise of one level only: where the level changes, white noise with a density of
    // its own stands for it.
    SensorModel with_noise(SensorModel model) const {
        SensorModel steady = with_density(model, AngleNoise::as_seen);
        if (!changes_level(left_by(steady))) { return steady; }
        model = with_density(std::move(model), AngleNoise::none);
        const Observation left = left_by(model);
        for (const std::size_t axis : left.prediction().axes()) {
            const std::vector<double> levels = levels_of(left, axis, slots_).level;
            model.effects.push_back(level_entry(levels, axis, static_cast<double>(slots_) / rows_->rate_hz));
        }
        return model;
    }

    bool changes_level(const Observation& left) const {
        double evidence_nats = 0.0;
        for (const std::size_t axis : left.prediction().axes()) {
            evidence_nats += levels_of(left, axis, slots_).evidence_nats;
        }
        return evidence_nats > 0.0;
    }

    ReferenceQuality quality(const Observation& left) const {
        ReferenceQuality quality;
        quality.samples_per_row = rows_->samples_per_row;
        for (const std::size_t axis : left.prediction().axes()) {
            const std::vector<double> levels = levels_of(left, axis, slots_).level;
            const double sd_rad_s =
                std::sqrt(mean_density(left.prediction().bins(), left.axis(axis).power) * rows_->rate_hz);
            quality.error_rad_s[axis] = {sd_rad_s * quantile(levels, resolution::quiet_share),
                                         sd_rad_s * quantile(levels, 1.0 - resolution::quiet_share)};
        }
        put_latency(left, quality);
        quality.bandwidth_hz = bandwidth_hz(left);
        return quality;
    }

private:
    std::shared_ptr<const Recording> rows_;
    std::uint64_t seed_;
    std::size_t slots_;
};

double most_error_rad_s(const ReferenceQuality& quality) {
    double sum = 0.0;
    double axes = 0.0;
    for (const Span& error_rad_s : quality.error_rad_s) {
        sum += error_rad_s.to * error_rad_s.to;
        axes += error_rad_s.to > 0.0 ? 1.0 : 0.0;
    }
    return axes > 0.0 ? std::sqrt(sum / axes) : 0.0;
}

}  // namespace

WithReferenceError with_reference_error(SensorModel model, const std::shared_ptr<const Recording>& rows,
                                        std::uint64_t seed) {
    const ErrorReader reader(rows, seed);
    const ReferenceQuality quality =
        reader.quality(reader.left_by(reader.with_density(model, AngleNoise::as_seen)));
    // A sensor does not follow the error of its reference: what acts on it is the rate without, as far as
    // that can be told from the error where it is largest.
    model.ref_noise_rad_s = most_error_rad_s(quality);
    return {reader.with_noise(std::move(model)), quality};
}

ReferenceQuality quality_of_rates(const SensorModel& model, const std::shared_ptr<const Recording>& rows,
                                  const std::array<double, 3>& noise_rad_s, std::uint64_t seed) {
    const ErrorReader reader(rows, seed);
    ReferenceQuality quality =
        reader.quality(reader.left_by(reader.with_density(model, AngleNoise::as_seen)));
    quality.is_known_at_rest = true;
    for (std::size_t axis = 0; axis < noise_rad_s.size(); ++axis) {
        quality.error_rad_s.at(axis) = {noise_rad_s.at(axis), noise_rad_s.at(axis)};
    }
    return quality;
}

}  // namespace gyrolog
