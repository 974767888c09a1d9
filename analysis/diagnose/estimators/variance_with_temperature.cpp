#include "analysis/diagnose/estimators/variance_with_temperature.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/axis_subsets.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/diagnose/likelihood/variance_fit.hpp"
#include "analysis/diagnose/likelihood/white_distribution.hpp"
#include "analysis/diagnose/likelihood/white_share.hpp"
#include "analysis/simulate/effects/white_noise_gain.hpp"

namespace gyrolog {

namespace {

// Relative change per degree about the mean temperature, and the gain as a parabola about it.
struct Slope {
    std::size_t axis = 0;
    double per_C = 0.0;
    double sd_per_C = 1.0;
    double gain_nats = 0.0;
    double share = 1.0;
    double dispersion = 1.0;
    WhitenedBlocks blocks;
};

class VarianceWithTemperatureEstimator final : public Estimator {
public:
    VarianceWithTemperatureEstimator(const EffectDefinition& effect,
                                     std::shared_ptr<const Prediction> prediction)
        : effect_(effect), prediction_(std::move(prediction)) {
        const std::vector<float>& temperature_C = prediction_->temperature_C();
        double sum = 0.0;
        for (const float each : temperature_C) { sum += static_cast<double>(each); }
        mean_C_ = sum / static_cast<double>(temperature_C.size());
        double squares = 0.0;
        for (const float each : temperature_C) {
            squares += std::pow(static_cast<double>(each) - mean_C_, 2.0);
        }
        sd_C_ = std::sqrt(squares / static_cast<double>(temperature_C.size()));
        const auto& temperature = prediction_->model().temperature;
        reference_C_ = temperature ? temperature->reference_C : TemperatureModel{}.reference_C;
    }

    // What the estimate's standard deviation is for one axis.
    double expected_sd_per_C() const {
        return 1.0 / (std::sqrt(2.0 * static_cast<double>(prediction_->length())) * sd_C_);
    }
    double most_per_C() const { return effect_.params[0].plausible_to; }
    double sd_C() const { return sd_C_; }

    std::optional<Finding> find(const Observation& observation) const override {
        std::vector<Slope> slopes;
        std::vector<std::size_t> members;
        for (const std::size_t axis : prediction_->axes()) {
            if (std::optional<Slope> slope = slope_of(observation, axis)) {
                members.push_back(slopes.size());
                slopes.push_back(std::move(*slope));
            }
        }
        std::vector<AxesFit> single;
        std::optional<AxesFit> shared;
        for (const std::vector<std::size_t>& subset : axis_subsets(members)) {
            AxesFit fit = fit_of(observation, slopes, subset);
            if (subset.size() == 1) {
                single.push_back(std::move(fit));
            } else if (!shared || fit.evidence_nats() > shared->evidence_nats()) {
                shared = std::move(fit);
            }
        }
        std::optional<Finding> finding = best_of(effect_, single, 0.0, shared);
        if (!finding) { return std::nullopt; }
        finding->evidence_nats -= axis_choice_nats(prediction_->axes().size());
        finding->where.temperature = true;
        return finding;
    }

private:
    std::vector<double> warmth_by_block(const WhitenedBlocks& blocks) const {
        std::vector<double> warmth_C(blocks.size());
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            const std::size_t middle =
                std::min(i * blocks.length + blocks.length / 2, prediction_->length() - 1);
            warmth_C[i] = static_cast<double>(prediction_->temperature_C()[middle]) - mean_C_;
        }
        return warmth_C;
    }

    static std::vector<double> levels(const std::vector<double>& warmth_C, double share, double per_C) {
        std::vector<double> level(warmth_C.size());
        for (std::size_t i = 0; i < level.size(); ++i) {
            const double gain = std::max(white_gain_least, 1.0 + per_C * warmth_C[i]);
            level[i] = 1.0 - share + share * gain * gain;
        }
        return level;
    }

    double gain_at(const Slope& slope, double per_C) const {
        return course_gain_nats(slope.blocks, levels(warmth_by_block(slope.blocks), slope.share, per_C)) /
               slope.dispersion;
    }

    // The parabola's top, found again nearer to it.
    void climb(Slope& slope) const {
        const std::vector<double> warmth_C = warmth_by_block(slope.blocks);
        const auto gain = [&](double per_C) {
            return course_gain_nats(slope.blocks, levels(warmth_C, slope.share, per_C)) / slope.dispersion;
        };
        double known = 0.0;
        double weight = 0.0;
        double mean = 0.0;
        for (std::size_t i = 0; i < warmth_C.size(); ++i) {
            weight += slope.blocks.weight[i];
            mean += slope.blocks.weight[i] * warmth_C[i];
        }
        mean /= weight;
        for (std::size_t i = 0; i < warmth_C.size(); ++i) {
            known += 2.0 * slope.blocks.weight[i] * std::pow(slope.share * (warmth_C[i] - mean), 2.0);
        }
        const double most = decisions.beyond_plausible * most_per_C();
        slope.sd_per_C = std::sqrt(slope.dispersion / std::max(known, 1e-9));
        const double step = std::min(slope.sd_per_C, 0.25 * most);
        double top = 0.0;
        double highest = 0.0;
        for (int round = 0; round < 20; ++round) {
            const double below = gain(top - step);
            const double above = gain(top + step);
            const double curvature = 2.0 * highest - below - above;
            const double move = curvature > 0.0 ? 0.5 * step * (above - below) / curvature
                                : above > below ? step
                                                : -step;
            const double next = std::clamp(top + std::clamp(move, -0.25 * most, 0.25 * most), -most, most);
            const double there = gain(next);
            if (!(there > highest)) { break; }
            const bool close = there - highest < 1e-3;
            top = next;
            highest = there;
            if (curvature > 0.0) { slope.sd_per_C = step / std::sqrt(curvature); }
            if (close) { break; }
        }
        slope.per_C = top;
        slope.gain_nats = highest;
    }

    std::optional<Slope> slope_of(const Observation& observation, std::size_t axis) const {
        const WhitenedBlocks plain = whitened_blocks(observation, axis);
        if (!plain.has_noise()) { return std::nullopt; }
        const double nu = white_degrees_of_freedom(*prediction_, axis);
        Slope slope;
        slope.axis = axis;
        slope.share = white_share(*prediction_, axis).variance;
        slope.blocks = with_tails(plain, observation, axis, nu);
        climb(slope);
        if (slope.gain_nats < resolution::worth_refining_nats) { return slope; }
        const double beside = tails_beside(plain, observation, axis, nu);
        if (beside != nu) {
            slope.blocks = with_tails(plain, observation, axis, beside);
            climb(slope);
        }
        slope.dispersion =
            overdispersion(slope.blocks, levels(warmth_by_block(slope.blocks), slope.share, slope.per_C));
        slope.gain_nats /= slope.dispersion;
        slope.sd_per_C *= std::sqrt(slope.dispersion);
        return slope;
    }

    // The axis' white noise at the mean temperature, relative to the nuisance's.
    double level_at_mean(const Slope& slope, double per_C) const {
        const double all =
            unit_level(slope.blocks, levels(warmth_by_block(slope.blocks), slope.share, per_C));
        return std::sqrt(std::max(0.0, 1.0 + (all * all - 1.0) / slope.share));
    }

    AxesFit fit_of(const Observation& observation, const std::vector<Slope>& slopes,
                   const std::vector<std::size_t>& subset) const {
        double weight = 0.0;
        double sum = 0.0;
        for (const std::size_t member : subset) {
            const Slope& slope = slopes[member];
            weight += 1.0 / (slope.sd_per_C * slope.sd_per_C);
            sum += slope.per_C / (slope.sd_per_C * slope.sd_per_C);
        }
        const double per_C = sum / weight;
        const double sd_per_C = 1.0 / std::sqrt(weight);
        const EffectParam& param = effect_.params[0];
        AxesFit fit;
        fit.cost_nats = parameter_cost_nats(param.plausible_to - param.plausible_from, sd_per_C);
        // Were there no noise to speak of at the reference, it would be no reference.
        const double at_reference = 1.0 + per_C * (reference_C_ - mean_C_);
        double of_level = 0.0;
        bool near = at_reference > 0.2;
        std::vector<double> level_gain;
        for (const std::size_t member : subset) {
            const Slope& slope = slopes[member];
            fit.axes.push_back(slope.axis);
            fit.gain_nats.push_back(gain_at(slope, per_C));
            const double level = level_at_mean(slope, per_C);
            const double there = level_cost_nats(observation, slope.axis, level * at_reference);
            level_gain.push_back(level_cost_nats(observation, slope.axis, level) - there);
            of_level += level_gain.back();
            near = near && there < decisions.seen_nats();
        }
        const bool certain = fit.evidence_nats() > decisions.seen_nats();
        // Where the level at the model's own reference is the model's, that counts too.
        const bool from_reference = near && of_level > 0.0;
        const double scale = from_reference ? at_reference : 1.0;
        fit.params[std::string(param.name)] = per_C / scale;
        fit.sd[std::string(param.name)] = sd_per_C / scale;
        fit.params[std::string(effect_.params[1].name)] = from_reference ? reference_C_ : mean_C_;
        if (from_reference && certain) {
            for (std::size_t i = 0; i < subset.size(); ++i) { fit.gain_nats[i] += level_gain[i]; }
            fit.spectral_nats = std::move(level_gain);
        }
        return fit;
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
    double mean_C_ = 0.0;
    double sd_C_ = 0.0;
    double reference_C_ = 25.0;
};

}  // namespace

MadeEstimator make_variance_with_temperature_estimator(const EffectDefinition& effect,
                                                       std::shared_ptr<const Prediction> prediction) {
    if (prediction->temperature_C().empty()) { return {nullptr, "the recording has no temperature"}; }
    auto estimator = std::make_unique<VarianceWithTemperatureEstimator>(effect, std::move(prediction));
    // The largest plausible change must be seen.
    if (!(estimator->sd_C() > 0.0) ||
        decisions.seen_sigma * estimator->expected_sd_per_C() > estimator->most_per_C()) {
        return {nullptr, "the temperature hardly changes"};
    }
    return {std::move(estimator), {}};
}

}  // namespace gyrolog
