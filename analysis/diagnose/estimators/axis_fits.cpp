#include "analysis/diagnose/estimators/axis_fits.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

namespace {

Finding finding_of(const EffectDefinition& effect, const std::vector<AxesFit>& fits,
                   double common_cost_nats) {
    Finding finding;
    finding.effect = effect.name;
    finding.evidence_nats = -common_cost_nats;
    for (const AxesFit& fit : fits) {
        EffectModel entry;
        entry.effect = effect.name;
        entry.params = fit.params;
        for (std::size_t i = 0; i < fit.axes.size(); ++i) {
            entry.axes.emplace_back(axis_names[fit.axes[i]]);
            finding.axis_gain_nats[fit.axes[i]] = fit.gain_nats[i];
            if (!fit.spectral_nats.empty()) {
                finding.axis_spectral_nats[fit.axes[i]] = fit.spectral_nats[i];
            }
            finding.where.axes.push_back(fit.axes[i]);
        }
        finding.entries.push_back(std::move(entry));
        finding.sd.push_back(fit.sd);
        finding.parameters += static_cast<int>(fit.sd.size());
        finding.gain_nats += fit.total_gain_nats();
        finding.evidence_nats += fit.evidence_nats();
    }
    std::ranges::sort(finding.where.axes);
    return finding;
}

}  // namespace

double AxesFit::total_gain_nats() const { return std::accumulate(gain_nats.begin(), gain_nats.end(), 0.0); }

const EffectParam& param_of(const EffectDefinition& effect, std::string_view name) {
    return *std::ranges::find(effect.params, name, &EffectParam::name);
}

double occam_cost_nats(const EffectParam& param, double value, double sd) {
    const double from = param.plausible_from;
    const double to = param.plausible_to;
    const bool logarithmic = from > 0.0 && to > from && value > 0.0;
    const double range = logarithmic ? std::log(to / from) : to - from;
    double cost = parameter_cost_nats(range, logarithmic ? sd / value : sd);
    // What is plausible ends as a normal distribution does, a sigma of half the range, not at a wall.
    const double beyond = logarithmic ? std::max(std::log(value / to), std::log(from / value))
                                      : std::max(value - to, from - value);
    if (beyond > 0.0 && range > 0.0) { cost += 2.0 * beyond * beyond / (range * range); }
    return cost;
}

std::optional<Finding> best_of(const EffectDefinition& effect, const std::vector<AxesFit>& single,
                               double common_cost_nats, const std::optional<AxesFit>& shared) {
    std::optional<Finding> best;
    if (!single.empty()) {
        std::vector<AxesFit> taken;
        std::ranges::copy_if(single, std::back_inserter(taken),
                             [](const AxesFit& fit) { return fit.evidence_nats() > 0.0; });
        if (taken.empty()) {
            taken.push_back(*std::ranges::max_element(single, {}, &AxesFit::evidence_nats));
        }
        best = finding_of(effect, taken, common_cost_nats);
    }
    if (shared && (!best || shared->evidence_nats() > best->evidence_nats)) {
        best = finding_of(effect, {*shared}, 0.0);
    }
    return best && best->gain_nats > 0.0 ? best : std::nullopt;
}

}  // namespace gyrolog
