#include "analysis/diagnose/estimators/quantisation_step.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_subsets.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/numerics/uniform.hpp"
#include "analysis/recording/grid_step.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog::resolution {

constexpr std::size_t codes_max = 4096;   // a change that is looked at
constexpr std::size_t coarser_max = 256;  // times the model's step
constexpr std::size_t rows_scanned = 20000;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// In white sigmas: a finer step adds next to nothing to the variance.
double step_that_matters() { return std::sqrt(resolution::negligible_share / variance_of_uniform(1.0)); }

struct Changes {
    std::vector<double> of_codes =
        std::vector<double>(resolution::codes_max, 0.0);  // by size in codes; 0 left out
    double on_grid = 0.0;
    double off_grid = 0.0;
};

Changes count_changes(const Column& column, const Recording& recording, double code) {
    Changes changes;
    std::visit(
        [&](const auto& data) {
            for (const Segment& segment : recording.segments) {
                for (std::size_t row = segment.first + 1; row < segment.first + segment.count; ++row) {
                    const double step =
                        std::fabs(static_cast<double>(data[row]) - static_cast<double>(data[row - 1])) / code;
                    const double codes = std::round(step);
                    if (codes >= static_cast<double>(resolution::codes_max)) { continue; }
                    if (std::fabs(step - codes) > on_grid_tolerance) {
                        changes.off_grid += 1.0;
                    } else if (codes > 0.0) {
                        changes.of_codes[static_cast<std::size_t>(codes)] += 1.0;
                        changes.on_grid += 1.0;
                    }
                }
            }
        },
        column.data);
    return changes;
}

struct Step {
    double rad_s = 0.0;
    double gain_nats = 0.0;
};

// Of changes that are whole codes: the multiple that they are of more often than chance has it.
Step coarser_multiple(const Changes& changes, double code_rad_s) {
    Step best;
    const double all = changes.on_grid;
    for (std::size_t m = 2; m <= resolution::coarser_max; ++m) {
        double hits = 0.0;
        for (std::size_t codes = m; codes < resolution::codes_max; codes += m) {
            hits += changes.of_codes[codes];
        }
        const double share = hits / all;
        if (share < decisions.nearly_all) { continue; }
        const double chance = 1.0 / static_cast<double>(m);
        double gain_nats = hits * std::log(share / chance);
        if (hits < all) { gain_nats += (all - hits) * std::log((1.0 - share) / (1.0 - chance)); }
        if (gain_nats > best.gain_nats) { best = {code_rad_s * static_cast<double>(m), gain_nats}; }
    }
    return best;
}

class QuantisationStepEstimator final : public Estimator {
public:
    QuantisationStepEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(&effect), prediction_(std::move(prediction)) {}

    std::optional<Finding> find(const Observation& observation) const override {
        Finding finding;
        finding.effect = effect_->name;
        for (const std::size_t axis : prediction_->axes()) {
            const Step step = step_of(observation.recording(), axis);
            if (step.gain_nats > 0.0) { add(axis, step, finding); }
        }
        if (finding.entries.empty()) { return std::nullopt; }
        finding.where.structure = effect_->signature->structure;
        finding.parameters = static_cast<int>(finding.entries.size());
        const EffectParam& range = effect_->params.front();
        // Steps are whole multiples of the finest.
        finding.evidence_nats =
            finding.gain_nats - axis_choice_nats(prediction_->axes().size()) -
            finding.parameters * parameter_cost_nats(range.plausible_to, range.plausible_from);
        return finding;
    }

private:
    double expected_step_rad_s(std::size_t axis) const {
        double step_rad_s = prediction_->model().lsb_rad_s;
        for (const EffectModel& entry : prediction_->model().effects) {
            if (entry.effect != effect_->name || !acts_on(entry, axis)) { continue; }
            step_rad_s = std::max(step_rad_s, EffectValues(entry)["lsb_dps"] * rad_per_deg);
        }
        return step_rad_s;
    }

    Step step_of(const Recording& recording, std::size_t axis) const {
        const Column& column = *recording.find(gyro_columns[axis]);
        const double unit_rad_s = std::fabs(column.scale);
        const double expected_rad_s = expected_step_rad_s(axis);
        if (expected_rad_s > 0.0) {
            const Changes changes = count_changes(column, recording, expected_rad_s / unit_rad_s);
            if (changes.on_grid == 0.0 && changes.off_grid == 0.0) { return {}; }
            if (changes.on_grid > decisions.nearly_all * (changes.on_grid + changes.off_grid)) {
                return coarser_multiple(changes, expected_rad_s);
            }
        }
        return free_step(
            column, recording, expected_rad_s,
            step_that_matters() * std::sqrt(prediction_->parts(axis).back().white * recording.rate_hz));
    }

    // On no multiple of what is expected.
    static Step free_step(const Column& column, const Recording& recording, double expected_rad_s,
                          double least_rad_s) {
        double step_rad_s = std::fabs(column.scale);
        if (const auto* values = std::get_if<std::vector<double>>(&column.data)) {
            step_rad_s *=
                grid_step(std::span(*values).first(std::min(values->size(), resolution::rows_scanned)));
        } else {
            const Step multiple = coarser_multiple(count_changes(column, recording, 1.0), step_rad_s);
            step_rad_s = std::max(step_rad_s, multiple.rad_s);
        }
        if (step_rad_s <= std::max(least_rad_s, expected_rad_s * (1.0 + decisions.same_step_rel))) {
            return {};
        }
        const Changes changes = count_changes(column, recording, step_rad_s / std::fabs(column.scale));
        if (changes.on_grid <= decisions.nearly_all * (changes.on_grid + changes.off_grid)) { return {}; }
        const double chance = expected_rad_s > 0.0 ? expected_rad_s / step_rad_s : 2.0 * on_grid_tolerance;
        return {step_rad_s, changes.on_grid * -std::log(chance)};
    }

    // To the entry of axes with the same step.
    void add(std::size_t axis, const Step& step, Finding& finding) const {
        const double step_dps = step.rad_s / rad_per_deg;
        const auto same = std::ranges::find_if(finding.entries, [&](const EffectModel& entry) {
            return std::fabs(entry.params.at("lsb_dps") / step_dps - 1.0) < 0.1 * decisions.same_step_rel;
        });
        if (same != finding.entries.end()) {
            same->axes.emplace_back(axis_names[axis]);
        } else {
            finding.entries.push_back({.effect = finding.effect,
                                       .axes = {axis_names[axis]},
                                       .params = {{"lsb_dps", step_dps}},
                                       .carried_json = {}});
            // As far as printed decimals may put the grid's far end.
            finding.sd.push_back({{"lsb_dps", step_dps * 1e-6}});
        }
        finding.where.axes.push_back(axis);
        finding.axis_gain_nats[axis] = step.gain_nats;
        finding.gain_nats += step.gain_nats;
    }

    const EffectDefinition* effect_;
    std::shared_ptr<const Prediction> prediction_;
};

}  // namespace

MadeEstimator make_quantisation_step_estimator(const EffectDefinition& effect,
                                               std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<QuantisationStepEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
