#include "analysis/diagnose/estimators/variance_change_point.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_subsets.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/diagnose/likelihood/variance_fit.hpp"
#include "analysis/diagnose/likelihood/white_distribution.hpp"
#include "analysis/diagnose/likelihood/white_share.hpp"
#include "analysis/numerics/golden_section.hpp"
#include "analysis/numerics/log_sum_exp.hpp"
#include "analysis/numerics/simplex_search.hpp"

namespace gyrolog::resolution {

constexpr std::size_t ramp_ends = 32;     // times between which ramps are tried
constexpr std::size_t ramp_blocks = 256;  // of which the variances are compared with a ramp
constexpr double side_samples_min = 256.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

const double log_factor_most = std::log(20.0);

// In slots. A step has no length.
struct ChangeCourse {
    double at = 0.0;
    double length = 0.0;

    // Share of the change that has been reached, on average from one slot to another.
    double reached(double from, double to) const { return (area(to) - area(from)) / (to - from); }

private:
    double area(double slot) const {
        const double since = slot - at;
        if (since <= 0.0) { return 0.0; }
        return since < length ? 0.5 * since * since / length : since - 0.5 * length;
    }
};

// One course on one axis.
struct ChangeTrial {
    double gain_nats = -std::numeric_limits<double>::infinity();
    double log_factor = 0.0;
    double log_sd = 1.0;
};

struct Scan {
    std::size_t axis = 0;
    double share = 1.0;
    WhitenedBlocks blocks;
    WhitenedBlocks coarse;
    std::vector<ChangeTrial> steps;  // by course
    std::vector<ChangeTrial> ramps;
};

struct Factor {
    double log_value = 0.0;
    double log_sd = 1.0;
    double gain_nats = 0.0;
    double dispersion = 1.0;  // by which the gain was divided
};

// Of a course for some axes.
struct ChangeFit {
    std::vector<const Scan*> scans;
    ChangeCourse course;
    std::array<double, 2> course_sd{};  // of start and length
    std::vector<Factor> factors;
    double place_cost_nats = 0.0;  // of the freedom to choose the times
    double evidence_nats = 0.0;
};

std::vector<double> reached_by_block(const WhitenedBlocks& blocks, const ChangeCourse& course) {
    std::vector<double> reached(blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const auto from = static_cast<double>(i * blocks.length);
        reached[i] = course.reached(from, from + static_cast<double>(blocks.length));
    }
    return reached;
}

std::vector<double> levels(std::span<const double> reached, double share, double log_factor) {
    std::vector<double> level(reached.size());
    for (std::size_t i = 0; i < reached.size(); ++i) {
        const double gain = 1.0 + std::expm1(log_factor) * reached[i];
        level[i] = 1.0 - share + share * gain * gain;
    }
    return level;
}

// What is known of ln factor: weighted sum of squares about the mean of what is reached.
double spread(const WhitenedBlocks& blocks, std::span<const double> reached) {
    double weight = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        weight += blocks.weight[i];
        sum += blocks.weight[i] * reached[i];
        squares += blocks.weight[i] * reached[i] * reached[i];
    }
    return weight > 0.0 ? std::max(0.0, squares - sum * sum / weight) : 0.0;
}

// Without any white noise nothing is known.
double share_of(const Scan& scan) { return std::max(scan.share, 1e-3); }

double log_factor_sd(const Scan& scan, double spread) {
    return 1.0 / std::sqrt(std::max(2.0 * spread, 1e-9)) / share_of(scan);
}

class VarianceChangePointEstimator final : public Estimator {
public:
    VarianceChangePointEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), prediction_(std::move(prediction)) {
        const EffectParam& factor = effect_.params[0];
        log_factor_range_ = std::log(factor.plausible_to / factor.plausible_from);
        const std::size_t length = WhitenedBlocks::length_for(prediction_->length());
        for (std::size_t block = 0; block < prediction_->length() / length; ++block) {
            steps_.push_back({static_cast<double>(block * length), 0.0});
        }
        const double step =
            static_cast<double>(prediction_->length()) / static_cast<double>(resolution::ramp_ends);
        for (std::size_t from = 0; from < resolution::ramp_ends; ++from) {
            for (std::size_t to = from + 1; to <= resolution::ramp_ends; ++to) {
                ramps_.push_back({step * static_cast<double>(from), step * static_cast<double>(to - from)});
            }
        }
    }

    std::optional<Finding> find(const Observation& observation) const override {
        std::vector<Scan> scans;
        for (const std::size_t axis : prediction_->axes()) {
            if (std::optional<Scan> scan = scan_of(observation, axis)) { scans.push_back(std::move(*scan)); }
        }
        std::vector<std::size_t> members(scans.size());
        std::iota(members.begin(), members.end(), std::size_t{0});
        std::vector<const Scan*> best;
        double most = -std::numeric_limits<double>::infinity();
        for (const std::vector<std::size_t>& subset : axis_subsets(members)) {
            std::vector<const Scan*> chosen;
            chosen.reserve(subset.size());
            for (const std::size_t member : subset) { chosen.push_back(&scans[member]); }
            const double evidence = evidence_anywhere(chosen);
            if (evidence > most) {
                most = evidence;
                best = std::move(chosen);
            }
        }
        if (best.empty()) { return std::nullopt; }
        ChangeFit step = rough_fit(best, sum_of(best, &Scan::steps), steps_);
        ChangeFit ramp = rough_fit(best, sum_of(best, &Scan::ramps), ramps_);
        if (std::max(gain_of(step), gain_of(ramp)) < resolution::worth_refining_nats) { return std::nullopt; }
        refine(observation, step);
        refine(observation, ramp);
        return finding_of(observation, step.evidence_nats > ramp.evidence_nats ? step : ramp);
    }

private:
    std::optional<Scan> scan_of(const Observation& observation, std::size_t axis) const {
        Scan scan;
        scan.axis = axis;
        scan.share = white_share(*prediction_, axis).variance;
        const double nu = white_degrees_of_freedom(*prediction_, axis);
        const WhitenedBlocks plain = whitened_blocks(observation, axis);
        if (!plain.has_noise()) { return std::nullopt; }
        scan.blocks = with_tails(plain, observation, axis, nu);
        scan.coarse = joined(scan.blocks, resolution::ramp_blocks);
        scan_everywhere(scan);
        if (highest(scan) < resolution::worth_refining_nats) { return scan; }
        const double beside = tails_beside(plain, observation, axis, nu);
        if (beside != nu) {
            scan.blocks = with_tails(plain, observation, axis, beside);
            scan.coarse = joined(scan.blocks, resolution::ramp_blocks);
            scan_everywhere(scan);
        }
        return scan;
    }

    static double highest(const Scan& scan) {
        return std::max(std::ranges::max_element(scan.steps, {}, &ChangeTrial::gain_nats)->gain_nats,
                        std::ranges::max_element(scan.ramps, {}, &ChangeTrial::gain_nats)->gain_nats);
    }

    void scan_everywhere(Scan& scan) const {
        scan_steps(scan);
        scan_ramps(scan);
    }

    void scan_steps(Scan& scan) const {
        const WhitenedBlocks& blocks = scan.blocks;
        double all = 0.0;
        double all_square = 0.0;
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            all += blocks.weight[i];
            all_square += blocks.weight[i] * blocks.variance[i];
        }
        scan.steps.assign(blocks.size(), {});
        double left = 0.0;
        double left_square = 0.0;
        for (std::size_t i = 1; i < blocks.size(); ++i) {
            left += blocks.weight[i - 1];
            left_square += blocks.weight[i - 1] * blocks.variance[i - 1];
            const double right = all - left;
            const double right_square = all_square - left_square;
            if (left < resolution::side_samples_min || right < resolution::side_samples_min ||
                !(left_square > 0.0) || !(right_square > 0.0)) {
                continue;
            }
            const double gain =
                0.5 * (all * std::log(all_square / all) - left * std::log(left_square / left) -
                       right * std::log(right_square / right));
            scan.steps[i] = {gain, 0.5 * std::log(right_square / right * left / left_square) / share_of(scan),
                             log_factor_sd(scan, left * right / all)};
        }
    }

    // By the regression of the logarithms of the variances.
    void scan_ramps(Scan& scan) const {
        const WhitenedBlocks& blocks = scan.coarse;
        scan.ramps.clear();
        for (const ChangeCourse& ramp : ramps_) {
            const std::vector<double> reached = reached_by_block(blocks, ramp);
            double weight = 0.0;
            double x = 0.0;
            double y = 0.0;
            double xx = 0.0;
            double xy = 0.0;
            for (std::size_t i = 0; i < blocks.size(); ++i) {
                const double n = blocks.weight[i];
                if (n == 0.0 || !(blocks.variance[i] > 0.0)) { continue; }
                const double log_variance = std::log(blocks.variance[i]);
                weight += n;
                x += n * reached[i];
                y += n * log_variance;
                xx += n * reached[i] * reached[i];
                xy += n * reached[i] * log_variance;
            }
            const double across = xx - x * x / weight;
            const double along = xy - x * y / weight;
            const double gain = across > 0.0 ? 0.25 * along * along / across : 0.0;
            scan.ramps.push_back({gain, across > 0.0 ? 0.5 * along / across / share_of(scan) : 0.0,
                                  log_factor_sd(scan, across)});
        }
    }

    // Of a course on some axes: gains less what the factors cost, one for all axes or each its own.
    double worth_nats(const std::vector<const Scan*>& scans, std::vector<ChangeTrial> Scan::*trials,
                      std::size_t course) const {
        double gain = 0.0;
        double cost = 0.0;
        double weight = 0.0;
        double sum = 0.0;
        double squares = 0.0;
        for (const Scan* scan : scans) {
            const ChangeTrial& trial = (scan->*trials)[course];
            const double known = 1.0 / (trial.log_sd * trial.log_sd);
            gain += trial.gain_nats;
            cost += parameter_cost_nats(log_factor_range_, trial.log_sd);
            weight += known;
            sum += known * trial.log_factor;
            squares += known * trial.log_factor * trial.log_factor;
        }
        if (std::isinf(gain)) { return gain; }
        const double common_cost = parameter_cost_nats(log_factor_range_, 1.0 / std::sqrt(weight)) +
                                   0.5 * (squares - sum * sum / weight);
        const std::array<double, 2> ways = {gain - cost, gain - common_cost};
        return log_sum_exp(ways) - std::log(2.0);
    }
    std::vector<double> sum_of(const std::vector<const Scan*>& scans,
                               std::vector<ChangeTrial> Scan::*trials) const {
        std::vector<double> nats((scans.front()->*trials).size());
        for (std::size_t i = 0; i < nats.size(); ++i) { nats[i] = worth_nats(scans, trials, i); }
        return nats;
    }
    static double average(const std::vector<double>& nats) {
        return log_sum_exp(nats) - std::log(static_cast<double>(nats.size()));
    }

    // Each kind as likely as the other, all of a kind alike.
    double evidence_anywhere(const std::vector<const Scan*>& scans) const {
        const std::array<double, 2> kinds = {average(sum_of(scans, &Scan::steps)),
                                             average(sum_of(scans, &Scan::ramps))};
        return log_sum_exp(kinds) - std::log(2.0);
    }

    static ChangeFit rough_fit(const std::vector<const Scan*>& scans, const std::vector<double>& nats,
                               const std::vector<ChangeCourse>& courses) {
        ChangeFit fit;
        fit.scans = scans;
        const auto best = static_cast<std::size_t>(std::ranges::max_element(nats) - nats.begin());
        fit.course = courses[best];
        fit.place_cost_nats = nats[best] - average(nats) + std::log(2.0);
        fit_factors(fit);
        return fit;
    }

    double evidence_of(const ChangeFit& fit) const {
        double nats = gain_of(fit) - fit.place_cost_nats;
        for (const Factor& factor : fit.factors) {
            nats -= parameter_cost_nats(log_factor_range_, factor.log_sd);
        }
        return nats;
    }

    static double gain_of(const ChangeFit& fit) {
        double sum = 0.0;
        for (const Factor& factor : fit.factors) { sum += factor.gain_nats; }
        return sum;
    }

    static Factor factor_at(const Scan& scan, const WhitenedBlocks& blocks, std::span<const double> reached) {
        const auto gain = [&](double log_factor) {
            return course_gain_nats(blocks, levels(reached, scan.share, log_factor));
        };
        Factor factor;
        factor.log_value = place_of_top(gain, -log_factor_most, log_factor_most);
        factor.gain_nats = gain(factor.log_value);
        factor.log_sd = log_factor_sd(scan, spread(blocks, reached));
        return factor;
    }

    static void fit_factors(ChangeFit& fit) {
        fit.factors.clear();
        for (const Scan* scan : fit.scans) {
            fit.factors.push_back(factor_at(*scan, scan->blocks, reached_by_block(scan->blocks, fit.course)));
        }
    }

    void refine(const Observation& observation, ChangeFit& fit) const {
        const ChangeFit rough = fit;
        if (fit.course.length == 0.0) {
            refine_step(observation, fit);
        } else {
            refine_ramp(fit);
        }
        fit_factors(fit);
        if (gain_of(fit) < gain_of(rough)) {
            fit.course = rough.course;
            fit.factors = rough.factors;
        }
        allow_for_scatter(fit);
        fit.evidence_nats = evidence_of(fit);
    }

    // A gain is worth less where the blocks scatter more about the course than chance has it.
    static void allow_for_scatter(ChangeFit& fit) {
        for (std::size_t a = 0; a < fit.scans.size(); ++a) {
            const Scan& scan = *fit.scans[a];
            Factor& factor = fit.factors[a];
            factor.dispersion = overdispersion(
                scan.blocks, levels(reached_by_block(scan.blocks, fit.course), scan.share, factor.log_value));
            factor.gain_nats /= factor.dispersion;
            factor.log_sd *= std::sqrt(factor.dispersion);
        }
    }

    // To the sample, within a block and a half of where the blocks have it.
    void refine_step(const Observation& observation, ChangeFit& fit) const {
        const std::size_t length = fit.scans.front()->blocks.length;
        const auto middle = static_cast<std::size_t>(fit.course.at);
        const std::size_t from = middle - std::min(middle, length + length / 2);
        const std::size_t to = std::min(prediction_->length(), middle + length + length / 2);
        // Log-likelihood of a change at from + i, up to a constant.
        std::vector<double> nats(to - from + 1, 0.0);
        for (std::size_t a = 0; a < fit.scans.size(); ++a) {
            add_change_nats(observation, fit, a, from, nats);
        }
        const auto best = static_cast<std::size_t>(std::ranges::max_element(nats) - nats.begin());
        fit.course.at = static_cast<double>(from + best);
        const double fine = spread_of(nats, 1.0);
        const double coarse = spread_of(sum_of(fit.scans, &Scan::steps), static_cast<double>(length));
        fit.course_sd = {std::max(fine, coarse > static_cast<double>(length) ? coarse : 0.0), 0.0};
    }

    // Whether each sample near a step is of the variance before or after.
    void add_change_nats(const Observation& observation, const ChangeFit& fit, std::size_t a,
                         std::size_t from, std::vector<double>& nats) const {
        const Scan& scan = *fit.scans[a];
        const std::vector<double> reached = reached_by_block(scan.blocks, fit.course);
        const double before =
            std::pow(unit_level(scan.blocks, levels(reached, scan.share, fit.factors[a].log_value)), 2.0);
        const double gain = std::exp(fit.factors[a].log_value);
        const double after = before * (1.0 - scan.share + scan.share * gain * gain);
        const std::vector<float>& whitened = observation.axis(scan.axis).whitened;
        double sum = 0.0;
        for (std::size_t i = 0; i + 1 < nats.size(); ++i) {
            if (observation.present()[from + i]) {
                const auto w = static_cast<double>(whitened[from + i]);
                // An outlier tells nothing.
                const double square = std::min(w * w, 9.0 * std::max(before, after));
                sum += 0.5 * (std::log(after / before) + square / after - square / before);
            }
            nats[i + 1] += sum;
        }
    }

    // Standard deviation of a place with these log-likelihoods, `step` apart.
    static double spread_of(const std::vector<double>& nats, double step) {
        const double most = *std::ranges::max_element(nats);
        double weight = 0.0;
        double sum = 0.0;
        double squares = 0.0;
        for (std::size_t i = 0; i < nats.size(); ++i) {
            const double w = std::exp(nats[i] - most);
            const double at = step * static_cast<double>(i);
            weight += w;
            sum += w * at;
            squares += w * at * at;
        }
        return std::sqrt(std::max(squares / weight - sum * sum / (weight * weight), step * step / 12.0));
    }

    void refine_ramp(ChangeFit& fit) const {
        const auto slots = static_cast<double>(prediction_->length());
        // Start and end as shares of the record.
        const auto gain = [&](const std::vector<double>& ends) {
            if (ends[0] < 0.0 || ends[1] > 1.0 || ends[1] <= ends[0]) {
                return -std::numeric_limits<double>::infinity();
            }
            const ChangeCourse course{ends[0] * slots, (ends[1] - ends[0]) * slots};
            double sum = 0.0;
            for (const Scan* scan : fit.scans) {
                sum += factor_at(*scan, scan->coarse, reached_by_block(scan->coarse, course)).gain_nats;
            }
            return sum;
        };
        const double cell = 1.0 / static_cast<double>(resolution::ramp_ends);
        const SimplexMaximum maximum =
            simplex_maximum(gain, {fit.course.at / slots, (fit.course.at + fit.course.length) / slots},
                            -0.5 * cell, 0.01, 120);
        fit.course = {maximum.at[0] * slots, (maximum.at[1] - maximum.at[0]) * slots};
        fit.course_sd = ramp_sd(gain, maximum, 0.25 * cell);
        double narrow = std::log(2.0);
        for (double& sd : fit.course_sd) {
            narrow += parameter_cost_nats(1.0, sd);
            sd *= slots;
        }
        fit.place_cost_nats = std::max(fit.place_cost_nats, narrow);
    }

    // Of start and length, from the curvature of the gain over start and end.
    template <typename Gain>
    static std::array<double, 2> ramp_sd(const Gain& gain, const SimplexMaximum& maximum, double step) {
        // Inside the record, where all four neighbours are defined.
        const double start = std::max(maximum.at[0], step);
        const double end = std::min(maximum.at[1], 1.0 - step);
        if (end - start < 3.0 * step) { return {step, step}; }
        const double middle = gain({start, end});
        const double start_start = gain({start - step, end}) + gain({start + step, end}) - 2.0 * middle;
        const double end_end = gain({start, end - step}) + gain({start, end + step}) - 2.0 * middle;
        const double start_end = 0.25 * (gain({start + step, end + step}) + gain({start - step, end - step}) -
                                         gain({start + step, end - step}) - gain({start - step, end + step}));
        Eigen::Matrix2d information;
        information << -start_start, -start_end, -start_end, -end_end;
        information /= step * step;
        if (!(information.determinant() > 0.0) || !(information(0, 0) > 0.0)) { return {0.25, 0.25}; }
        const Eigen::Matrix2d covariance = information.inverse();
        return {std::min(0.3, std::sqrt(covariance(0, 0))),
                std::min(0.3, std::sqrt(covariance(0, 0) + covariance(1, 1) - 2.0 * covariance(0, 1)))};
    }

    // What it gains that the level before the change is the model's, where the mean level is not.
    double level_gain_nats(const Observation& observation, const ChangeFit& fit, std::size_t a) const {
        const Scan& scan = *fit.scans[a];
        const std::vector<double> reached = reached_by_block(scan.blocks, fit.course);
        const auto white_level = [&](const std::vector<double>& level) {
            const double all = unit_level(scan.blocks, level);
            return std::sqrt(std::max(0.0, 1.0 + (all * all - 1.0) / scan.share));
        };
        const double mean =
            level_cost_nats(observation, scan.axis, white_level(std::vector<double>(reached.size(), 1.0)));
        const double before = level_cost_nats(
            observation, scan.axis, white_level(levels(reached, scan.share, fit.factors[a].log_value)));
        return before < decisions.seen_nats() ? std::max(0.0, mean - before) : 0.0;
    }

    // One factor for all axes, where it is not much worse than their own.
    bool share_factor(ChangeFit& fit) const {
        if (fit.factors.size() < 2) { return true; }
        double weight = 0.0;
        double sum = 0.0;
        double cost = 0.0;
        for (const Factor& factor : fit.factors) {
            weight += 1.0 / (factor.log_sd * factor.log_sd);
            sum += factor.log_value / (factor.log_sd * factor.log_sd);
            cost += parameter_cost_nats(log_factor_range_, factor.log_sd);
        }
        const double sd = 1.0 / std::sqrt(weight);
        const double saved = cost - parameter_cost_nats(log_factor_range_, sd);
        std::vector<Factor> common;
        double lost = 0.0;
        for (std::size_t a = 0; a < fit.factors.size(); ++a) {
            const Scan& scan = *fit.scans[a];
            const std::vector<double> level =
                levels(reached_by_block(scan.blocks, fit.course), scan.share, sum / weight);
            const double dispersion = fit.factors[a].dispersion;
            common.push_back(
                {sum / weight, sd, course_gain_nats(scan.blocks, level) / dispersion, dispersion});
            lost += fit.factors[a].gain_nats - common.back().gain_nats;
        }
        if (lost > saved) { return false; }
        fit.factors = std::move(common);
        fit.evidence_nats += saved - lost;
        return true;
    }

    std::optional<Finding> finding_of(const Observation& observation, ChangeFit fit) const {
        const bool together = share_factor(fit);
        Finding finding;
        finding.effect = effect_.name;
        finding.evidence_nats = fit.evidence_nats;
        for (std::size_t a = 0; a < fit.scans.size(); ++a) {
            double gain = fit.factors[a].gain_nats;
            // The level before the change counts where the change is certain.
            if (fit.evidence_nats > decisions.seen_nats()) {
                const double of_level = level_gain_nats(observation, fit, a);
                gain += of_level;
                finding.evidence_nats += of_level;
                finding.axis_spectral_nats[fit.scans[a]->axis] = of_level;
            }
            const std::size_t axis = fit.scans[a]->axis;
            finding.gain_nats += gain;
            finding.axis_gain_nats[axis] = gain;
            finding.where.axes.push_back(axis);
            if (a == 0 || !together) { add_entry(fit, fit.factors[a], finding); }
            finding.entries.back().axes.emplace_back(axis_names[axis]);
        }
        const double from_s = fit.course.at / prediction_->rate_hz();
        finding.where.time_s = {from_s, from_s + fit.course.length / prediction_->rate_hz()};
        finding.parameters = static_cast<int>(finding.entries.size()) + (fit.course.length > 0.0 ? 2 : 1);
        if (!(finding.gain_nats > 0.0)) { return std::nullopt; }
        return finding;
    }

    void add_entry(const ChangeFit& fit, const Factor& factor, Finding& finding) const {
        const double rate_hz = prediction_->rate_hz();
        const std::array<std::string, 3> names = {std::string(effect_.params[0].name),
                                                  std::string(effect_.params[1].name),
                                                  std::string(effect_.params[2].name)};
        EffectModel entry;
        entry.effect = effect_.name;
        const double value = std::exp(factor.log_value);
        entry.params = {
            {names[0], value}, {names[1], fit.course.at / rate_hz}, {names[2], fit.course.length / rate_hz}};
        std::map<std::string, double> sd = {{names[0], value * factor.log_sd},
                                            {names[1], fit.course_sd[0] / rate_hz}};
        if (fit.course.length > 0.0) { sd[names[2]] = fit.course_sd[1] / rate_hz; }
        finding.entries.push_back(std::move(entry));
        finding.sd.push_back(std::move(sd));
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
    double log_factor_range_ = 0.0;
    std::vector<ChangeCourse> steps_;  // at the beginning of each block
    std::vector<ChangeCourse> ramps_;
};

}  // namespace

MadeEstimator make_variance_change_point_estimator(const EffectDefinition& effect,
                                                   std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<VarianceChangePointEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
