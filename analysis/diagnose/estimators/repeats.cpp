#include "analysis/diagnose/estimators/repeats.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/diagnose/likelihood/repeat_patterns.hpp"
#include "analysis/recording/grid_step.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog::resolution {

constexpr std::size_t block_rows = 2048;
constexpr std::size_t blocks_max = 512;
// A step distribution is known from so many.
constexpr double steps_min = 100.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

struct Quantities {
    std::vector<const Column*> columns;
    std::vector<std::size_t> places;     // among all quantities
    std::vector<std::size_t> axes;       // of the first columns; a last one more is the temperature
    std::vector<double> repeated_apart;  // by column, the share of rows that repeat the one before the last

    bool has_temperature() const { return columns.size() > axes.size(); }
    std::size_t temperature_bit() const { return has_temperature() ? std::size_t{1} << axes.size() : 0; }
};

std::vector<PatternCounts> in_one_block(const std::vector<PatternCounts>& blocks) {
    PatternCounts all{};
    for (const PatternCounts& counts : blocks) {
        for (std::size_t pattern = 0; pattern < counts.size(); ++pattern) { all[pattern] += counts[pattern]; }
    }
    return {all};
}

Quantities all_quantities(const Recording& recording, const Prediction& prediction) {
    Quantities all;
    for (const std::size_t axis : prediction.axes()) {
        all.columns.push_back(recording.find(gyro_columns[axis]));
        all.axes.push_back(axis);
    }
    if (const Column* temperature = recording.find("temp")) { all.columns.push_back(temperature); }
    return all;
}

// Of `all`, whose patterns over two rows are `apart`, those that carry news.
Quantities moving_quantities(const Quantities& all, const std::vector<PatternCounts>& apart) {
    const PatternCounts counts = in_one_block(apart).front();
    Quantities moving;
    for (std::size_t c = 0; c < all.columns.size(); ++c) {
        const double share = count_containing(counts, std::size_t{1} << c) / std::max(1.0, count_all(counts));
        // Carries no news: a dead axis, a thermometer in coarse steps.
        if (share > decisions.nearly_all) { continue; }
        moving.columns.push_back(all.columns[c]);
        moving.places.push_back(c);
        moving.repeated_apart.push_back(share);
        if (c < all.axes.size()) { moving.axes.push_back(all.axes[c]); }
    }
    return moving;
}

// Repeats in `set` at the share `eps`, against the share `expected`.
struct Excess {
    std::size_t set = 0;
    double eps = 0.0;
    double eps_sd = 0.0;
    double gain_nats = 0.0;
};

double eps_sd(double eps, double rows) { return std::sqrt(std::max(eps, 1.0 / rows) / rows); }

// Rows that repeat the one before in every quantity of a set, by the number of rows since the last such one.
std::vector<double> distances_of(const Recording& recording, const RowPatterns& patterns, std::size_t set) {
    std::vector<double> distances;
    for (const Segment& segment : recording.segments) {
        std::optional<std::size_t> last;
        for (std::size_t row = segment.first + 1; row < segment.first + segment.count; ++row) {
            if ((patterns[row] & set) != set) { continue; }
            if (last) { distances.push_back(static_cast<double>(row - *last)); }
            last = row;
        }
    }
    return distances;
}

struct Runs {
    double length = 0.0;
    double length_sd = 0.0;
};

// Empty for a beat: its repeats are 1 / eps rows apart, as nearly as whole numbers can be and eps is known.
// At random that is rare.
std::optional<Runs> random_runs(const std::vector<double>& distances, const Excess& excess) {
    const auto count = static_cast<double>(distances.size());
    if (count < decisions.repetitions_least()) { return std::nullopt; }
    const double period = 1.0 / excess.eps;
    const double near = 1.0 + decisions.seen_sigma * period * excess.eps_sd / excess.eps;
    double in_beat = 0.0;
    double runs = 1.0;
    for (const double distance : distances) {
        in_beat += std::fabs(distance - period) <= near ? 1.0 / count : 0.0;
        runs += distance > 1.0 ? 1.0 : 0.0;
    }
    const double by_chance =
        std::exp(-std::max(0.0, period - near) * excess.eps) - std::exp(-(period + near) * excess.eps);
    if (in_beat > definition::majority * (1.0 + by_chance)) { return std::nullopt; }
    const double length = (count + 1.0) / runs;
    return Runs{length, std::sqrt(std::max(length * (length - 1.0), 1.0 / runs) / runs)};
}

class RepeatEstimator final : public Estimator {
public:
    RepeatEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(&effect), prediction_(std::move(prediction)) {}

    std::optional<Finding> find(const Observation& observation) const override {
        const Recording& recording = observation.recording();
        const Quantities all = all_quantities(recording, *prediction_);
        const std::size_t blocks =
            std::clamp<std::size_t>(recording.rows() / resolution::block_rows, 1, resolution::blocks_max);
        const auto count_apart = [&](const RowPatterns& next, RowPatterns rows, std::size_t quantities) {
            leave_out_runs(next, quantities, rows);
            return count_patterns(recording, rows, 2, blocks);
        };
        const RowPatterns apart_rows = row_patterns(recording, all.columns, 2);
        RowPatterns near_rows = row_patterns(recording, all.columns, 1);
        std::vector<PatternCounts> apart = count_apart(near_rows, apart_rows, all.columns.size());
        const Quantities moving = moving_quantities(all, apart);
        if (moving.axes.empty()) { return std::nullopt; }
        if (moving.columns.size() < all.columns.size()) {
            near_rows = patterns_of_some(near_rows, moving.places);
            apart =
                count_apart(near_rows, patterns_of_some(apart_rows, moving.places), moving.columns.size());
        }
        std::size_t looked_at = 0;
        const std::vector<PatternCounts> near = count_patterns(recording, near_rows, 1, blocks);
        const std::optional<Excess> best =
            best_set(recording, moving, in_one_block(near), in_one_block(apart), looked_at);
        if (!best) { return std::nullopt; }
        Excess excess = *best;
        if (std::popcount(excess.set) > 1) { excess = together(near, apart, moving, excess.set); }
        if (excess.gain_nats < resolution::worth_refining_nats) { return std::nullopt; }
        Finding finding = finding_of(moving, excess, static_cast<double>(looked_at));
        // Of a single quantity some repeat by chance, which is at random in any case.
        if (std::popcount(excess.set) > 1) {
            if (const auto runs = random_runs(distances_of(recording, near_rows, excess.set), excess)) {
                finding.entries.front().params["run_length"] = runs->length;
                finding.sd.front()["run_length"] = runs->length_sd;
            }
        }
        return finding;
    }

private:
    std::optional<Excess> best_set(const Recording& recording, const Quantities& moving,
                                   const std::vector<PatternCounts>& near,
                                   const std::vector<PatternCounts>& apart, std::size_t& looked_at) const {
        const std::size_t axis_sets = std::size_t{1} << moving.axes.size();
        std::optional<Excess> best;
        const auto take = [&](const Excess& excess) {
            ++looked_at;
            if (excess.gain_nats < resolution::worth_refining_nats) { return; }
            if (!best || excess.gain_nats > best->gain_nats) { best = excess; }
        };
        for (std::size_t axes = 1; axes < axis_sets; ++axes) {
            if (std::popcount(axes) > 1) {
                take(together(near, apart, moving, axes));
            } else {
                take(alone(recording, moving, axes));
            }
            if (moving.has_temperature()) {
                take(together(near, apart, moving, axes | moving.temperature_bit()));
            }
        }
        return best;
    }

    Excess together(const std::vector<PatternCounts>& near, const std::vector<PatternCounts>& apart,
                    const Quantities& moving, std::size_t set) const {
        const std::size_t count = moving.columns.size();
        double rows = 0.0;
        for (const PatternCounts& counts : near) { rows += count_all(counts); }
        const RepeatFit seen = fit_repeats(near, count, set);
        const double expected = std::max(expected_eps(moving, set), fit_repeats(apart, count, set).eps);
        if (seen.eps <= expected) { return {}; }
        const RepeatFit chance = fit_chance(near, count, set, expected);
        return {set, seen.eps, eps_sd(seen.eps, rows),
                std::max(0.0, seen.log_likelihood_nats - chance.log_likelihood_nats)};
    }

    Excess alone(const Recording& recording, const Quantities& moving, std::size_t set) const;
    double expected_eps(const Quantities& moving, std::size_t set) const;
    double code(const Column& column, std::size_t axis) const;
    Finding finding_of(const Quantities& moving, const Excess& excess, double looked_at) const;

    const EffectDefinition* effect_;
    std::shared_ptr<const Prediction> prediction_;
};

double RepeatEstimator::expected_eps(const Quantities& moving, std::size_t set) const {
    double fresh = 1.0;
    for (const EffectModel& entry : prediction_->model().effects) {
        if (entry.effect != effect_->name) { continue; }
        bool acts = true;
        for (std::size_t c = 0; c < moving.axes.size(); ++c) {
            if ((set >> c & 1U) != 0U) { acts = acts && acts_on(entry, moving.axes[c]); }
        }
        if (acts) { fresh *= 1.0 - EffectValues(entry)["eps"]; }
    }
    return 1.0 - fresh;
}

// One code, in the column's own numbers; 0: the numbers lie on no grid.
double RepeatEstimator::code(const Column& column, std::size_t axis) const {
    double lsb_rad_s = prediction_->model().lsb_rad_s;
    for (const EffectModel& entry : prediction_->model().effects) {
        const auto step = entry.params.find("lsb_dps");
        if (step != entry.params.end() && acts_on(entry, axis)) {
            lsb_rad_s = std::max(lsb_rad_s, step->second * rad_per_deg);
        }
    }
    if (column.is_counts()) { return std::max(1.0, std::round(lsb_rad_s / std::fabs(column.scale))); }
    const auto& values = std::get<std::vector<double>>(column.data);
    return lsb_rad_s > 0.0 ? lsb_rad_s / std::fabs(column.scale)
                           : grid_step(std::span(values).first(std::min<std::size_t>(values.size(), 20000)));
}

struct Steps {
    double all = 0.0;
    std::array<double, 3> of_codes{};  // by size: 0, 1 and 2 codes
};

// Of a step's size, 0 to 2, or 3 for all that are larger.
std::size_t codes_of(double step, double code) {
    const double codes = code > 0.0 ? step / code + 0.5 : step == 0.0 ? 0.0 : 3.0;
    return static_cast<std::size_t>(std::min(codes, 3.0));
}

Steps count_steps(const Column& column, const Recording& recording, double code) {
    std::array<std::size_t, 4> of_codes{};
    std::visit(
        [&](const auto& data) {
            const ValueRange range(data);
            for (const Segment& segment : recording.segments) {
                for (std::size_t row = segment.first + 1; row < segment.first + segment.count; ++row) {
                    if (range.ends_at(data[row])) { continue; }
                    const double step =
                        std::fabs(static_cast<double>(data[row]) - static_cast<double>(data[row - 1]));
                    ++of_codes[codes_of(step, code)];
                }
            }
        },
        column.data);
    Steps steps;
    for (const std::size_t count : of_codes) { steps.all += static_cast<double>(count); }
    std::copy_n(of_codes.begin(), steps.of_codes.size(), steps.of_codes.begin());
    return steps;
}

double binomial_nats(double share, double of, double p) {
    const double hits = share > 0.0 ? share * std::log(p) : 0.0;
    const double others = share < 1.0 ? (1.0 - share) * std::log1p(-p) : 0.0;
    return of * (hits + others);
}

Excess RepeatEstimator::alone(const Recording& recording, const Quantities& moving, std::size_t set) const {
    const auto c = static_cast<std::size_t>(std::countr_zero(set));
    const Column& column = *moving.columns[c];
    const Steps steps = count_steps(column, recording, code(column, moving.axes[c]));
    if (steps.all == 0.0) { return {}; }
    const double share = steps.of_codes[0] / steps.all;
    const double of_one = 0.5 * steps.of_codes[1];
    const double of_two = 0.5 * steps.of_codes[2];
    double chance = std::max(moving.repeated_apart[c], 1.0 / steps.all);
    double chance_sd_rel = decisions.smoothness_rel;
    if (of_two > resolution::steps_min) {
        chance = std::pow(of_one / steps.all, 4.0 / 3.0) / std::pow(of_two / steps.all, 1.0 / 3.0);
        chance_sd_rel = std::hypot(decisions.smoothness_rel, 4.0 / 3.0 / std::sqrt(of_one),
                                   1.0 / 3.0 / std::sqrt(of_two));
    }
    const double expected = expected_eps(moving, set);
    chance = expected + (1.0 - expected) * std::min(chance, 0.99);
    if (share <= chance) { return {}; }
    // The chance is free within its uncertainty: the best between it and what is seen.
    double best_nats = -1e300;
    for (int i = 0; i <= 200; ++i) {
        const double p = chance + (share - chance) * static_cast<double>(i) / 200.0;
        const double z = (p - chance) / (chance_sd_rel * chance);
        best_nats = std::max(best_nats, binomial_nats(share, steps.all, p) - 0.5 * z * z);
    }
    const double eps = expected + (share - chance) / (1.0 - chance);
    return {set, eps, std::hypot(eps_sd(eps, steps.all), chance_sd_rel * chance),
            std::max(0.0, binomial_nats(share, steps.all, share) - best_nats)};
}

Finding RepeatEstimator::finding_of(const Quantities& moving, const Excess& excess, double looked_at) const {
    Finding finding;
    finding.effect = effect_->name;
    finding.parameters = 1;
    EffectModel entry{
        .effect = finding.effect, .axes = {}, .params = {{"eps", excess.eps}}, .carried_json = {}};
    for (std::size_t c = 0; c < moving.axes.size(); ++c) {
        if ((excess.set >> c & 1U) == 0U) { continue; }
        entry.axes.emplace_back(axis_names[moving.axes[c]]);
        finding.where.axes.push_back(moving.axes[c]);
    }
    // What all axes do that carry news, the sensor does.
    if (finding.where.axes == moving.axes) { entry.axes.assign(axis_names.begin(), axis_names.end()); }
    finding.entries = {std::move(entry)};
    finding.sd = {{{"eps", excess.eps_sd}}};
    finding.where.structure = effect_->signature->structure;
    finding.gain_nats = excess.gain_nats;
    for (const std::size_t axis : finding.where.axes) {
        finding.axis_gain_nats[axis] = excess.gain_nats / static_cast<double>(finding.where.axes.size());
    }
    const EffectParam& range = effect_->params.front();
    finding.evidence_nats = excess.gain_nats - std::log(looked_at) -
                            parameter_cost_nats(std::log(range.plausible_to / range.plausible_from),
                                                std::min(1.0, excess.eps_sd / excess.eps));
    return finding;
}

}  // namespace

MadeEstimator make_repeat_estimator(const EffectDefinition& effect,
                                    std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<RepeatEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
