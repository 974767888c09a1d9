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

PlausibleRange::PlausibleRange(const EffectParam& param, double value) {
    const double from = param.plausible_from;
    const double to = param.plausible_to;
    const bool logarithmic = from > 0.0 && to > from && value > 0.0;
    const double range = logarithmic ? std::log(to / from) : to - from;
    width = logarithmic ? value * range : range;
    const double beyond = logarithmic ? std::max(std::log(value / to), std::log(from / value))
                                      : std::max(value - to, from - value);
    if (beyond > 0.0 && range > 0.0) { beyond_nats = 2.0 * beyond * beyond / (range * range); }
}

double occam_cost_nats(const EffectParam& param, double value, double sd) {
    const PlausibleRange range(param, value);
    return parameter_cost_nats(range.width, sd) + range.beyond_nats;
}

double joint_occam_cost_nats(std::span<const EffectParam* const> params, std::span<const double> values,
                             const Matrix& information) {
    std::vector<double> widths;
    double beyond_nats = 0.0;
    for (std::size_t i = 0; i < params.size(); ++i) {
        const PlausibleRange range(*params[i], values[i]);
        widths.push_back(range.width);
        beyond_nats += range.beyond_nats;
    }
    return joint_parameter_cost_nats(information, widths) + beyond_nats;
}

Matrix information_of_values(const Matrix& of_logarithms, std::span<const double> values) {
    Matrix information(values.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (std::size_t j = 0; j < values.size(); ++j) {
            information(i, j) = of_logarithms(i, j) / (values[i] * values[j]);
        }
    }
    return information;
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
