#include "analysis/diagnose/estimators/density_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "analysis/diagnose/estimators/gain_band.hpp"
#include "analysis/diagnose/likelihood/whittle.hpp"
#include "analysis/simulate/autoregression.hpp"

namespace gyrolog::resolution {

// Half of the effect's own order: it follows the shape through its table.
constexpr std::array<std::size_t, 10> orders_tried = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32};
constexpr int expectations = 20;
// Of the factor, by which the straight line between two points of a table may be off.
constexpr double table_error = 0.02;
constexpr std::size_t table_first_points = 9;
constexpr int table_halvings = 6;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Integrals of a cosine of so many samples' lag over each bin, in turns, times two: zero lag first.
using LagIntegrals = std::vector<std::vector<double>>;

// The bins' edges, in turns a sample.
std::vector<double> bin_edges_turns(const SpectralBins& bins, std::size_t length) {
    std::vector<double> edges = {0.0};
    for (const SpectralBin& bin : bins) {
        edges.push_back(0.5 * static_cast<double>(bin.end) / static_cast<double>(length));
    }
    edges.back() = 0.5;
    return edges;
}

LagIntegrals lag_integrals(const std::vector<double>& edges_turns, std::size_t lag_most) {
    LagIntegrals integrals(lag_most + 1);
    for (std::size_t b = 0; b + 1 < edges_turns.size(); ++b) {
        const double from = edges_turns[b];
        const double to = edges_turns[b + 1];
        integrals[0].push_back(2.0 * (to - from));
        for (std::size_t lag = 1; lag <= lag_most; ++lag) {
            const double rad = 2.0 * pi * static_cast<double>(lag);
            integrals[lag].push_back(2.0 * (std::sin(rad * to) - std::sin(rad * from)) / rad);
        }
    }
    return integrals;
}

// White noise of an axis and what else is expected there, by bin.
struct AxisNoise {
    std::vector<double> white;
    std::vector<double> other;
};

class DensityTableEstimator final : public Estimator {
public:
    DensityTableEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect),
          prediction_(std::move(prediction)),
          integrals_(lag_integrals(bin_edges_turns(prediction_->bins(), prediction_->length()),
                                   resolution::orders_tried.back())) {}

    std::optional<Finding> find(const Observation& observation) const override {
        Finding finding;
        finding.effect = effect_.name;
        std::vector<double> gains_nats(bins().size(), 0.0);
        for (const std::size_t axis : prediction_->axes()) {
            add_axis(observation, axis, finding, gains_nats);
        }
        if (finding.entries.empty()) { return std::nullopt; }
        put_gain_band(bins(), std::move(gains_nats), finding.where);
        return finding;
    }

private:
    const SpectralBins& bins() const { return prediction_->bins(); }

    void add_axis(const Observation& observation, std::size_t axis, Finding& finding,
                  std::vector<double>& gains_nats) const {
        const AxisObservation& seen = observation.axis(axis);
        const AxisNoise noise = noise_of(observation, axis);
        if (std::ranges::any_of(noise.white, [](double white) { return !(white > 0.0); })) { return; }
        std::optional<EffectModel> best;
        double best_evidence_nats = 0.0;
        for (const std::size_t order : resolution::orders_tried) {
            EffectModel entry = entry_of(fitted(noise, seen.power, order), axis);
            const double gain_nats = gain_of(entry, noise, seen);
            const double evidence_nats = gain_nats - cost_nats(order);
            if (evidence_nats <= best_evidence_nats) { continue; }
            best = std::move(entry);
            best_evidence_nats = evidence_nats;
            finding.axis_gain_nats.at(axis) = gain_nats;
        }
        if (!best) { return; }
        const std::vector<double> density = density_with(*best, noise);
        for (std::size_t i = 0; i < bins().size(); ++i) {
            gains_nats[i] += bin_gain_nats(bins()[i], seen.power[i], seen.density[i], density[i]);
        }
        finding.gain_nats += finding.axis_gain_nats.at(axis);
        finding.evidence_nats += best_evidence_nats;
        finding.where.axes.push_back(axis);
        finding.sd.emplace_back();
        finding.entries.push_back(*std::move(best));
    }

    AxisNoise noise_of(const Observation& observation, std::size_t axis) const {
        std::vector<SpectralParts> white_alone = prediction_->parts(axis);
        for (SpectralParts& parts : white_alone) { parts = {.white = parts.white}; }
        AxisNoise noise{std::vector<double>(bins().size()), observation.axis(axis).density};
        expected_density(white_alone, noise_uncertainty(prediction_->model(), axis),
                         observation.axis(axis).noise.z, noise.white);
        for (std::size_t i = 0; i < bins().size(); ++i) {
            noise.other[i] = std::max(noise.other[i] - noise.white[i], 0.0);
        }
        return noise;
    }

    Autoregression fitted(const AxisNoise& noise, const std::vector<double>& power, std::size_t order) const {
        std::vector<double> factor(bins().size(), 1.0);
        std::optional<Autoregression> process;
        for (int i = 0; i < resolution::expectations; ++i) {
            for (std::size_t b = 0; b < bins().size(); ++b) {
                // Of two independent normal parts whose sum is seen.
                const double white = factor[b] * noise.white[b];
                const double share = white / (white + noise.other[b]);
                factor[b] = share * (share * power[b] + noise.other[b]) / noise.white[b];
            }
            process.emplace(covariances(factor, order));
            for (std::size_t b = 0; b < bins().size(); ++b) {
                factor[b] = process->density(bins()[b].f_hz / prediction_->rate_hz());
            }
        }
        return *std::move(process);
    }

    // Of a density that is level in each bin.
    std::vector<double> covariances(const std::vector<double>& factor, std::size_t order) const {
        std::vector<double> sums;
        for (std::size_t lag = 0; lag <= order; ++lag) {
            sums.push_back(std::inner_product(factor.begin(), factor.end(), integrals_[lag].begin(), 0.0));
        }
        return sums;
    }

    EffectModel entry_of(const Autoregression& process, std::size_t axis) const {
        EffectModel entry{std::string(effect_.name), {axis_names.at(axis)}, {}, ""};
        std::vector<double>& at = entry.table[std::string(effect_.table->at)];
        std::vector<double>& value = entry.table[std::string(effect_.table->value)];
        const auto add = [&](double turns) {
            at.push_back(turns * prediction_->rate_hz());
            value.push_back(process.density(turns));
        };
        const auto between = [&](auto self, double from, double to, int halvings) -> void {
            const double middle = 0.5 * (from + to);
            const double straight = 0.5 * (process.density(from) + process.density(to));
            const double off = std::fabs(process.density(middle) / straight - 1.0);
            if (halvings == 0 || off < resolution::table_error) { return; }
            self(self, from, middle, halvings - 1);
            add(middle);
            self(self, middle, to, halvings - 1);
        };
        const double step = 0.5 / static_cast<double>(resolution::table_first_points - 1);
        add(0.0);
        for (std::size_t i = 1; i < resolution::table_first_points; ++i) {
            const double to = step * static_cast<double>(i);
            between(between, to - step, to, resolution::table_halvings);
            add(to);
        }
        return entry;
    }

    std::vector<double> density_with(const EffectModel& entry, const AxisNoise& noise) const {
        std::vector<SpectralParts> parts(bins().size());
        for (std::size_t i = 0; i < parts.size(); ++i) {
            parts[i] = {.white = noise.white[i], .other = noise.other[i]};
        }
        effect_.signature->spectrum(prediction_->bin_frequencies_hz(), prediction_->rate_hz(),
                                    EffectValues(entry), parts);
        std::vector<double> density;
        density.reserve(parts.size());
        for (const SpectralParts& part : parts) { density.push_back(part.sum()); }
        return density;
    }

    double gain_of(const EffectModel& entry, const AxisNoise& noise, const AxisObservation& seen) const {
        return whittle_log_likelihood_nats(bins(), seen.power, density_with(entry, noise)) -
               whittle_log_likelihood_nats(bins(), seen.power, seen.density);
    }

    // Of the coefficients and the variance.
    double cost_nats(std::size_t order) const {
        double coefficients = 0.0;
        for (const SpectralBin& bin : bins()) { coefficients += bin.count(); }
        return 0.5 * static_cast<double>(order + 1) * std::log(coefficients);
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
    LagIntegrals integrals_;
};

}  // namespace

MadeEstimator make_density_table_estimator(const EffectDefinition& effect,
                                           std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<DensityTableEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
