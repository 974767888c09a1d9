#include "analysis/diagnose/estimators/sampling_jitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/estimators/stamp_evidence.hpp"
#include "analysis/diagnose/likelihood/noise_nuisance.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/diagnose/likelihood/white_share.hpp"
#include "analysis/numerics/golden_section.hpp"

namespace gyrolog::resolution {

constexpr int bins_per_octave = 4;
constexpr double bins_most = 40.0 * bins_per_octave;
constexpr double worth_checking_nats = 100.0;
constexpr double log_sd_step = 0.05;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Slots of like d^2 together; the likelihood needs no more than their number and sum of squares.
struct Bin {
    double change_square = 0.0;  // mean d^2
    double count = 0.0;
    double squares = 0.0;  // of whitened samples, in units of the model's own white noise
};

struct AxisBins {
    std::vector<Bin> bins;
    double white_variance = 0.0;  // of one sample
    double level_sd = 0.0;        // of c about 1, from N's uncertainty
};

double level_log_likelihood_nats(const AxisBins& axis, double level, double sd_s) {
    double nats = 0.0;
    for (const Bin& bin : axis.bins) {
        const double variance = level + sd_s * sd_s * bin.change_square / axis.white_variance;
        nats -= 0.5 * (bin.count * std::log(variance) + bin.squares / variance);
    }
    const double z = (level - 1.0) / axis.level_sd;
    return nats - 0.5 * z * z;
}

double best_level_nats(const AxisBins& axis, double sd_s) {
    const auto nats = [&](double level) { return level_log_likelihood_nats(axis, level, sd_s); };
    return nats(place_of_top(nats, 0.3, 4.0));
}

class SamplingJitterEstimator final : public Estimator {
public:
    SamplingJitterEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(&effect), prediction_(std::move(prediction)) {
        for (const std::size_t axis : prediction_->axes()) {
            for (const float change : prediction_->response_change_rad_s2(axis)) {
                // From a ten thousandth of a rad/s^2.
                const double place =
                    resolution::bins_per_octave *
                    std::log2(1.0 + static_cast<double>(change) * static_cast<double>(change) * 1e8);
                bin_of_slot_[axis].push_back(
                    static_cast<std::uint8_t>(std::min(place, resolution::bins_most - 1.0)));
            }
        }
    }

    std::optional<Finding> find(const Observation& observation) const override {
        if (is_known()) { return std::nullopt; }
        std::vector<AxisBins> axes;
        for (const std::size_t axis : prediction_->axes()) { axes.push_back(gathered(observation, axis)); }
        const auto nats = [&](double sd_s) {
            double sum = 0.0;
            for (const AxisBins& axis : axes) { sum += best_level_nats(axis, sd_s); }
            return sum;
        };
        const EffectParam& range = *std::ranges::find(effect_->params, "sd_s", &EffectParam::name);
        const double without = nats(0.0);
        const double log_sd =
            place_of_top([&](double log_s) { return nats(std::exp(log_s)); },
                         std::log(0.2 * range.plausible_from), std::log(3.0 * range.plausible_to));
        const double sd_s = std::exp(log_sd);
        double gain_nats = nats(sd_s) - without;
        if (gain_nats < resolution::worth_refining_nats) { return std::nullopt; }
        // What a model misses of the motion's mean answer is larger where the rate changes, too.
        if (gain_nats > resolution::worth_checking_nats) {
            gain_nats = std::min(gain_nats, checked_nats(observation, sd_s));
        }
        if (gain_nats < resolution::worth_refining_nats) { return std::nullopt; }
        const double curvature = 2.0 * nats(sd_s) - nats(sd_s * std::exp(resolution::log_sd_step)) -
                                 nats(sd_s * std::exp(-resolution::log_sd_step));
        const double rel_sd =
            curvature > 0.0 ? std::min(1.0, resolution::log_sd_step / std::sqrt(curvature)) : 1.0;
        Finding finding = whole_sensor_finding(*effect_, *prediction_, {{"sd_s", sd_s}, {"in_stamps", 0.0}},
                                               {{"sd_s", rel_sd * sd_s}});
        finding.gain_nats = gain_nats;
        for (std::size_t a = 0; a < axes.size(); ++a) {
            finding.axis_gain_nats[prediction_->axes()[a]] =
                best_level_nats(axes[a], sd_s) - best_level_nats(axes[a], 0.0);
        }
        finding.evidence_nats =
            gain_nats - parameter_cost_nats(std::log(range.plausible_to / range.plausible_from), rel_sd);
        return finding;
    }

private:
    // With the spread in the model: of the spectra, and of the variance's course in what is white by its own
    // spectrum, in which a mean answer that the model misses has no more weight than its frequencies.
    double checked_nats(const Observation& observation, double sd_s) const {
        SensorModel model = prediction_->model();
        model.effects.push_back({std::string(effect_->name), {}, {{"sd_s", sd_s}, {"in_stamps", 0.0}}, ""});
        const Observation with = observation.under(model);
        double nats = log_likelihood_nats(with) - log_likelihood_nats(observation);
        for (const std::size_t axis : prediction_->axes()) { nats += course_nats(with, axis); }
        return nats;
    }

    static double course_nats(const Observation& with, std::size_t axis) {
        const Prediction& prediction = with.prediction();
        const std::vector<float>& course = prediction.white_course(axis);
        if (course.empty()) { return 0.0; }
        const AxisObservation& seen = with.axis(axis);
        std::vector<double> white(seen.cosines.begin(), seen.cosines.end());
        for (std::size_t i = 0; i < prediction.bins().size(); ++i) {
            const SpectralBin& bin = prediction.bins()[i];
            const double density = std::max(seen.power[i], seen.density[i]);
            for (std::size_t k = bin.first; k < bin.end; ++k) {
                white[k] /= std::sqrt(density * prediction.rate_hz());
            }
        }
        prediction.transform()->inverse(white);
        const double share = white_share(prediction, axis).variance;
        double nats = 0.0;
        for (std::size_t slot = 0; slot < white.size(); ++slot) {
            if (!with.present()[slot]) { continue; }
            const double variance = 1.0 + share * (static_cast<double>(course[slot]) - 1.0);
            nats -= 0.5 * (std::log(variance) + white[slot] * white[slot] * (1.0 / variance - 1.0));
        }
        return nats;
    }

    AxisBins gathered(const Observation& observation, std::size_t axis) const {
        const AxisObservation& seen = observation.axis(axis);
        const std::vector<float>& change = prediction_->response_change_rad_s2(axis);
        AxisBins gathered;
        gathered.white_variance = prediction_->parts(axis).back().sum() * prediction_->rate_hz();
        const double sd_N = std::max(1e-4, noise_uncertainty(prediction_->model(), axis)[0]);
        gathered.level_sd =
            2.0 * sd_N * prediction_->parts(axis).back().white / prediction_->parts(axis).back().sum();
        // Of the observation's fitted noise over the model's.
        const double scale = seen.density.back() / prediction_->parts(axis).back().sum();
        std::vector<Bin> bins(static_cast<std::size_t>(resolution::bins_most));
        for (std::size_t slot = 0; slot < change.size(); ++slot) {
            if (!observation.present()[slot]) { continue; }
            const double d = static_cast<double>(change[slot]);
            const double white = static_cast<double>(seen.whitened[slot]);
            Bin& bin = bins[bin_of_slot_[axis][slot]];
            bin.change_square += d * d;
            bin.count += 1.0;
            bin.squares += white * white * scale;
        }
        for (Bin& bin : bins) {
            if (bin.count == 0.0) { continue; }
            bin.change_square /= bin.count;
            gathered.bins.push_back(bin);
        }
        return gathered;
    }

    // Then what it explains is no longer in the whitened samples.
    bool is_known() const {
        return std::ranges::any_of(prediction_->model().effects, [&](const EffectModel& entry) {
            return entry.effect == effect_->name && EffectValues(entry)["in_stamps"] == 0.0;
        });
    }

    const EffectDefinition* effect_;
    std::shared_ptr<const Prediction> prediction_;
    std::array<std::vector<std::uint8_t>, 3> bin_of_slot_;  // by how fast the rate changes there
};

}  // namespace

std::unique_ptr<Estimator> make_sampling_jitter_estimator(const EffectDefinition& effect,
                                                          std::shared_ptr<const Prediction> prediction) {
    if (!prediction->moves()) { return nullptr; }
    return std::make_unique<SamplingJitterEstimator>(effect, std::move(prediction));
}

}  // namespace gyrolog
