#include "analysis/diagnose/estimators/outliers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/axis_subsets.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/diagnose/likelihood/white_distribution.hpp"
#include "analysis/diagnose/likelihood/white_share.hpp"
#include "analysis/diagnose/likelihood/whitened_blocks.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/numerics/golden_section.hpp"
#include "analysis/numerics/log_sum_exp.hpp"

namespace gyrolog::resolution {

constexpr double size_step = 1.3;
constexpr double looked_at_sigma = 2.0;  // nearer to zero a spike and noise are not told apart
constexpr int em_rounds = 12;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Sizes in the unit of whitened samples.
struct Limits {
    double from = 0.0;
    double to = 0.0;
};

struct Mixed {
    double gain_nats = 0.0;  // without what the core's own scale gains
    double share = 0.0;      // of samples that are off
};

struct AxisSamples {
    std::size_t axis = 0;
    double per_dps = 0.0;  // of a histogram's unit
    WhitenedHistogram histogram;
    const NormalMixture* noise = nullptr;
    const LogDensityTable* log_noise = nullptr;
    double scale = 1.0;                // of the noise without spikes
    double core_gain_nats = 0.0;       // of that scale, against the best for all samples: below zero
    std::vector<std::size_t> far;      // histogram entries looked at
    std::vector<double> log_noise_at;  // of those
};

// Samples beyond the limit beside another one on the same side.
template <typename Take>
void for_each_in_run(const WhitenedBlocks& blocks, const Observation& observation, std::size_t axis,
                     Take take) {
    const std::vector<float>& whitened = observation.axis(axis).whitened;
    const auto limit = static_cast<float>(decisions.certain_sigma * blocks.level);
    const auto beyond = [&](std::size_t slot, bool up) {
        return observation.present()[slot] && (up ? whitened[slot] > limit : whitened[slot] < -limit);
    };
    for (std::size_t slot = 0; slot < whitened.size(); ++slot) {
        if (std::fabs(whitened[slot]) <= limit) { continue; }
        const bool up = whitened[slot] > 0.0F;
        const bool run =
            (slot > 0 && beyond(slot - 1, up)) || (slot + 1 < whitened.size() && beyond(slot + 1, up));
        if (run && beyond(slot, up)) { take(slot); }
    }
}

// Takes them out of the histogram.
void drop_runs(const WhitenedBlocks& blocks, const Observation& observation, std::size_t axis,
               WhitenedHistogram& histogram) {
    for_each_in_run(blocks, observation, axis, [&](std::size_t slot) {
        const std::size_t block = std::min(slot / blocks.length, blocks.size() - 1);
        const double n = blocks.weight[block] + 1.0;
        if (blocks.weight[block] == 0.0) { return; }
        const double off =
            std::fabs(static_cast<double>(observation.axis(axis).whitened[slot]) - blocks.mean[block]) *
            std::sqrt(n / (n - 1.0)) / blocks.level;
        std::size_t nearest = histogram.at.size();
        for (std::size_t i = 0; i < histogram.at.size(); ++i) {
            if (histogram.count[i] > 0.0 &&
                (nearest == histogram.at.size() ||
                 std::fabs(histogram.at[i] - off) < std::fabs(histogram.at[nearest] - off))) {
                nearest = i;
            }
        }
        if (nearest == histogram.at.size()) { return; }
        histogram.count[nearest] -= 1.0;
        histogram.samples -= 1.0;
    });
}

double trimmed_sd(const WhitenedHistogram& histogram) {
    double samples = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < histogram.at.size(); ++i) {
        if (histogram.at[i] > decisions.outlier_sigma) { continue; }
        samples += histogram.count[i];
        squares += histogram.count[i] * histogram.at[i] * histogram.at[i];
    }
    return samples > 0.0 ? std::sqrt(squares / samples) : 1.0;
}

// A limit, and for each entry looked at the probability that noise on a spike of that size stays below it.
struct LimitAt {
    double size = 0.0;
    std::vector<double> noise_below;
};

LimitAt limit_at(const AxisSamples& samples, double size) {
    LimitAt limit{size, {}};
    for (const std::size_t entry : samples.far) {
        limit.noise_below.push_back(
            samples.noise->probability_below((samples.histogram.at[entry] - size) / samples.scale));
    }
    return limit;
}

// EM for the share of samples that are off, then the likelihood ratio against none.
Mixed mix(const AxisSamples& samples, const LimitAt& from, const LimitAt& to) {
    std::vector<double> log_ratio(samples.far.size());
    double expected = 0.0;
    for (std::size_t i = 0; i < samples.far.size(); ++i) {
        const double at = samples.histogram.at[samples.far[i]];
        const double inside = from.noise_below[i] - to.noise_below[i];
        log_ratio[i] = std::log(inside / (2.0 * (to.size - from.size))) - samples.log_noise_at[i];
        if (at > decisions.certain_sigma && log_ratio[i] > 0.0) {
            expected += samples.histogram.count[samples.far[i]];
        }
    }
    const double n = samples.histogram.samples;
    Mixed mixed;
    mixed.share = std::clamp(expected / n, 0.5 / n, 0.2);
    const auto odds = [&](std::size_t i) {
        return std::log(mixed.share / (1.0 - mixed.share)) + log_ratio[i];
    };
    for (int round = 0; round < resolution::em_rounds; ++round) {
        double off = 0.0;
        for (std::size_t i = 0; i < samples.far.size(); ++i) {
            off += samples.histogram.count[samples.far[i]] / (1.0 + std::exp(-odds(i)));
        }
        mixed.share = std::clamp(off / n, 1e-3 / n, 0.5);
    }
    mixed.gain_nats = n * std::log1p(-mixed.share);
    for (std::size_t i = 0; i < samples.far.size(); ++i) {
        const double log_odds = odds(i);
        const double gain = log_odds > 30.0 ? log_odds : std::log1p(std::exp(log_odds));
        mixed.gain_nats += samples.histogram.count[samples.far[i]] * gain;
    }
    return mixed;
}

class OutlierEstimator final : public Estimator {
public:
    OutlierEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), prediction_(std::move(prediction)) {
        const EffectParam& number = effect_.params[0];
        log_number_range_ = std::log(number.plausible_to / number.plausible_from);
        for (const std::size_t axis : prediction_->axes()) {
            noise_[axis] = std::make_unique<NormalMixture>(
                whitened_mixture(*prediction_, axis, white_degrees_of_freedom(*prediction_, axis)));
            log_noise_[axis] = std::make_unique<LogDensityTable>(*noise_[axis]);
        }
    }

    std::optional<Finding> find(const Observation& observation) const override {
        std::vector<AxisSamples> all;
        for (const std::size_t axis : prediction_->axes()) {
            if (std::optional<AxisSamples> samples = samples_of(observation, axis)) {
                all.push_back(std::move(*samples));
            }
        }
        if (all.empty()) { return std::nullopt; }
        const std::vector<double> sizes_dps = sizes_to_try(all);
        const std::vector<SizePair> pairs = pairs_of(sizes_dps.size());
        // By axis and pair.
        std::vector<std::vector<double>> nats;
        nats.reserve(all.size());
        for (const AxisSamples& samples : all) {
            nats.push_back(worth_of_pairs_nats(samples, sizes_dps, pairs));
        }
        std::vector<std::size_t> members(all.size());
        std::iota(members.begin(), members.end(), std::size_t{0});
        Choice best;
        for (const std::vector<std::size_t>& subset : axis_subsets(members)) {
            std::vector<double> sum(pairs.size(), 0.0);
            for (const std::size_t member : subset) {
                for (std::size_t i = 0; i < sum.size(); ++i) { sum[i] += nats[member][i]; }
            }
            const double evidence = log_sum_exp(sum) - std::log(static_cast<double>(sum.size()));
            if (best.members.empty() || evidence > best.evidence_nats) {
                const auto top = static_cast<std::size_t>(std::ranges::max_element(sum) - sum.begin());
                best = {subset, evidence, sum[top], {sizes_dps[pairs[top].from], sizes_dps[pairs[top].to]}};
            }
        }
        refine(all, best);
        return finding_of(all, best);
    }

private:
    // Places in a list of sizes.
    struct SizePair {
        std::size_t from = 0;
        std::size_t to = 0;
    };

    struct Choice {
        std::vector<std::size_t> members;
        double evidence_nats = 0.0;
        double worth_nats = 0.0;  // at the limits
        Limits limits_dps;
    };

    std::optional<AxisSamples> samples_of(const Observation& observation, std::size_t axis) const {
        const WhitenedBlocks blocks = whitened_blocks(observation, axis);
        if (!blocks.has_noise()) { return std::nullopt; }
        AxisSamples samples;
        samples.axis = axis;
        samples.per_dps = rad_per_deg * whitened_per_rad_s(observation, axis) / blocks.level;
        samples.histogram = whitened_histogram(blocks, observation, axis);
        drop_runs(blocks, observation, axis, samples.histogram);
        samples.noise = noise_[axis].get();
        samples.log_noise = log_noise_[axis].get();
        const ScaledFit plain =
            fit_scale(samples.histogram, *samples.log_noise, std::sqrt(samples.histogram.moment(2)));
        const bool normal = std::isinf(white_degrees_of_freedom(*prediction_, axis));
        samples.scale = normal ? trimmed_sd(samples.histogram) : plain.scale;
        double core = -samples.histogram.samples * std::log(samples.scale);
        double excess = 0.0;
        for (std::size_t i = 0; i < samples.histogram.at.size(); ++i) {
            const double count = samples.histogram.count[i];
            if (count == 0.0) { continue; }
            const double at = samples.histogram.at[i];
            const double log_density = (*samples.log_noise)(at / samples.scale);
            core += count * log_density;
            if (at < resolution::looked_at_sigma) { continue; }
            samples.far.push_back(i);
            samples.log_noise_at.push_back(log_density - std::log(samples.scale));
            // Were every sample here a spike, and rare.
            excess +=
                count * std::max(0.0, -samples.log_noise_at.back() - std::log(samples.histogram.samples));
        }
        samples.core_gain_nats = core - plain.log_likelihood_nats;
        return excess > resolution::worth_refining_nats ? std::optional(std::move(samples)) : std::nullopt;
    }

    std::vector<double> sizes_to_try(const std::vector<AxisSamples>& all) const {
        // Of one sample, in means of several.
        const auto in_rows = static_cast<double>(prediction_->world().recording().samples_per_row);
        double largest_dps = resolution::size_step * effect_.params[2].plausible_to / in_rows;
        for (const AxisSamples& samples : all) {
            for (const std::size_t i : samples.far) {
                largest_dps = std::max(largest_dps, 1.1 * samples.histogram.at[i] / samples.per_dps);
            }
        }
        std::vector<double> sizes = {effect_.params[1].plausible_from / (resolution::size_step * in_rows)};
        while (sizes.back() < largest_dps) { sizes.push_back(sizes.back() * resolution::size_step); }
        return sizes;
    }

    static std::vector<SizePair> pairs_of(std::size_t sizes) {
        std::vector<SizePair> pairs;
        for (std::size_t from = 0; from < sizes; ++from) {
            for (std::size_t to = from + 1; to < sizes; ++to) { pairs.push_back({from, to}); }
        }
        return pairs;
    }

    // What the noise says of a size is worked out once, for all its pairs.
    std::vector<double> worth_of_pairs_nats(const AxisSamples& samples, const std::vector<double>& sizes_dps,
                                            const std::vector<SizePair>& pairs) const {
        std::vector<LimitAt> limits;
        limits.reserve(sizes_dps.size());
        for (const double size_dps : sizes_dps) {
            limits.push_back(limit_at(samples, size_dps * samples.per_dps));
        }
        std::vector<double> nats;
        nats.reserve(pairs.size());
        for (const SizePair& pair : pairs) {
            nats.push_back(worth_nats(samples, mix(samples, limits[pair.from], limits[pair.to])));
        }
        return nats;
    }

    static Mixed mix_dps(const AxisSamples& samples, const Limits& limits_dps) {
        return mix(samples, limit_at(samples, limits_dps.from * samples.per_dps),
                   limit_at(samples, limits_dps.to * samples.per_dps));
    }

    // Of a number of Poisson events: known to one in its square root.
    double number_cost_nats(double number) const {
        return parameter_cost_nats(log_number_range_, 1.0 / std::sqrt(std::max(number, 1.0)));
    }

    // Gain less the cost of the number.
    double worth_nats(const AxisSamples& samples, const Mixed& mixed) const {
        return mixed.gain_nats + samples.core_gain_nats -
               number_cost_nats(mixed.share * samples.histogram.samples);
    }

    void refine(const std::vector<AxisSamples>& all, Choice& choice) const {
        if (choice.evidence_nats < 0.0) { return; }
        const auto worth = [&](const Limits& limits) {
            double sum = 0.0;
            for (const std::size_t member : choice.members) {
                sum += worth_nats(all[member], mix_dps(all[member], limits));
            }
            return sum;
        };
        Limits limits = choice.limits_dps;
        for (int round = 0; round < 2; ++round) {
            limits.from = place_of_top(
                [&](double from) {
                    return worth({from, limits.to});
                },
                limits.from / resolution::size_step,
                std::min(limits.from * resolution::size_step, 0.98 * limits.to));
            limits.to = place_of_top(
                [&](double to) {
                    return worth({limits.from, to});
                },
                std::max(limits.to / resolution::size_step, 1.02 * limits.from),
                limits.to * resolution::size_step);
        }
        const double there = worth(limits);
        if (there < choice.worth_nats) { return; }
        choice.evidence_nats += there - choice.worth_nats;
        choice.worth_nats = there;
        choice.limits_dps = limits;
    }

    std::optional<Finding> finding_of(const std::vector<AxisSamples>& all, const Choice& choice) const {
        Finding finding;
        finding.effect = effect_.name;
        finding.evidence_nats = choice.evidence_nats;
        std::vector<double> numbers;
        Span sigmas{std::numeric_limits<double>::infinity(), 0.0};
        double noise_dps = 0.0;
        for (const std::size_t member : choice.members) {
            const AxisSamples& samples = all[member];
            const Mixed mixed = mix_dps(samples, choice.limits_dps);
            numbers.push_back(mixed.share * samples.histogram.samples);
            finding.axis_gain_nats[samples.axis] = mixed.gain_nats + samples.core_gain_nats;
            finding.gain_nats += finding.axis_gain_nats[samples.axis];
            finding.where.axes.push_back(samples.axis);
            noise_dps = std::max(noise_dps, 1.0 / samples.per_dps);
            sigmas.from = std::min(sigmas.from, choice.limits_dps.from * samples.per_dps);
            sigmas.to = std::max(sigmas.to, choice.limits_dps.to * samples.per_dps);
        }
        if (!(finding.gain_nats > 0.0)) { return std::nullopt; }
        finding.where.amplitude_sigma = sigmas;
        finding.where.structure = effect_.signature->structure;
        add_entries(choice, noise_dps, numbers, finding);
        return finding;
    }

    // One number for all axes where theirs differ no more than chance has it.
    void add_entries(const Choice& choice, double noise_dps, const std::vector<double>& numbers,
                     Finding& finding) const {
        const double total = std::accumulate(numbers.begin(), numbers.end(), 0.0);
        const double mean = total / static_cast<double>(numbers.size());
        double lost = 0.0;
        double saved = -number_cost_nats(total);
        for (const double number : numbers) {
            lost += number > 0.0 ? number * std::log(number / mean) : 0.0;
            saved += number_cost_nats(number);
        }
        const bool together = numbers.size() > 1 && saved > lost;
        if (together) {
            finding.evidence_nats += saved - lost;
            finding.gain_nats -= lost;
        }
        for (std::size_t a = 0; a < numbers.size(); ++a) {
            if (a == 0 || !together) {
                add_entry(choice.limits_dps, noise_dps, together ? mean : numbers[a],
                          together ? total : numbers[a], total, finding);
            }
            finding.entries.back().axes.emplace_back(axis_names[finding.where.axes[a]]);
        }
        finding.parameters = static_cast<int>(finding.entries.size()) + 2;
    }

    // `seen`: spikes that tell of the number; `all`: that tell of the limits.
    void add_entry(const Limits& limits_dps, double noise_dps, double number, double seen, double all,
                   Finding& finding) const {
        const std::string per_hour(effect_.params[0].name);
        const std::string smallest(effect_.params[1].name);
        const std::string largest(effect_.params[2].name);
        const double hours = prediction_->duration_s() / s_per_h;
        // Of m uniform numbers the extremes lie within their limits by a part m + 1 of the range; and each is
        // known no better than the noise lets it.
        const double limit_sd = std::hypot((limits_dps.to - limits_dps.from) / (all + 1.0), noise_dps);
        EffectModel entry;
        entry.effect = effect_.name;
        entry.params = {{per_hour, number / hours}, {smallest, limits_dps.from}, {largest, limits_dps.to}};
        finding.entries.push_back(std::move(entry));
        finding.sd.push_back({{per_hour, number / hours / std::sqrt(std::max(seen, 1.0))},
                              {smallest, limit_sd},
                              {largest, limit_sd}});
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
    double log_number_range_ = 0.0;
    std::array<std::unique_ptr<NormalMixture>, 3> noise_;
    std::array<std::unique_ptr<LogDensityTable>, 3> log_noise_;
};

}  // namespace

MadeEstimator make_outlier_estimator(const EffectDefinition& effect,
                                     std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<OutlierEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
