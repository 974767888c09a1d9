#include "analysis/diagnose/calibration/null_bias.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/diagnose/calibration/null_simulations.hpp"
#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/same_cause.hpp"

namespace gyrolog::resolution {

constexpr std::size_t null_bias_simulations = 16;

}  // namespace gyrolog::resolution

namespace gyrolog {

double NullBias::of(const Finding& finding) const {
    const std::vector<std::size_t>& on = finding.where.axes;
    const bool is_beside = on.empty() || std::ranges::find_first_of(on, axes) != on.end();
    const auto found = is_beside ? nats.find(finding.effect) : nats.end();
    return found == nats.end() ? 0.0 : found->second;
}

double NullBias::taken_over_nats(const Finding& rival, const Hypotheses& beside_all) const {
    for (const std::optional<Finding>& one : beside_all.findings) {
        if (one && is_same_cause(*one, rival, beside_all.prediction->duration_s())) {
            return rival.evidence_nats - std::max(one->evidence_nats - of(*one), 0.0);
        }
    }
    return rival.evidence_nats;
}

std::optional<std::map<std::string, double>> null_bias_nats(const Hypotheses& hypotheses, std::uint64_t seed,
                                                            unsigned threads,
                                                            const std::function<bool()>& told) {
    const NullSimulationOptions options{resolution::null_bias_simulations, seed,
                                        RandomPurpose::null_bias_simulations, threads,
                                        [&](double) { return told(); }};
    const std::optional<NullSimulations> null =
        simulate_null(hypotheses.prediction, &hypotheses.catalogue, options);
    if (!null) { return std::nullopt; }
    std::map<std::string, double> bias_nats;
    for (std::size_t entry = 0; entry < hypotheses.catalogue.size(); ++entry) {
        double mean = 0.0;
        double square = 0.0;
        for (const std::vector<double>& of_effects : null->evidence_nats) {
            // How far below zero an effect lies that is not called for, or of which there is no trace, tells
            // nothing of how high chance takes it.
            const double nats = std::max(of_effects[entry], 0.0);
            mean += nats / static_cast<double>(resolution::null_bias_simulations);
            square += nats * nats / static_cast<double>(resolution::null_bias_simulations);
        }
        const double sd = std::sqrt(std::max(square - mean * mean, 0.0));
        bias_nats[std::string(hypotheses.catalogue[entry].effect->name)] =
            mean + decisions.certain_sigma * sd;
    }
    return bias_nats;
}

}  // namespace gyrolog
