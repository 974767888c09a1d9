// Axis fits are one effect's fits to single axes and to all together; best_of() tells which of them the data
// call for.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "analysis/numerics/matrix.hpp"
#include "analysis/simulate/effect.hpp"

namespace gyrolog {

// A fit whose parameters hold for some axes alike.
struct AxesFit {
    std::vector<std::size_t> axes;
    std::vector<double> gain_nats;      // by axis
    std::vector<double> spectral_nats;  // by axis, Finding::axis_spectral_nats; empty: none
    std::map<std::string, double> params;
    std::map<std::string, double> sd;  // of those that were fitted
    double cost_nats = 0.0;            // of the freedom of all of them

    double total_gain_nats() const;
    double evidence_nats() const { return total_gain_nats() - cost_nats; }
};

// What is plausible about a value of a parameter: uniform over the range, log-uniform where the range lies on
// one side of zero. It ends as a normal distribution does, a sigma of half the range, not at a wall.
struct PlausibleRange {
    PlausibleRange(const EffectParam& param, double value);

    double width = 0.0;  // in the parameter's unit, of a logarithmic range as it is at the value
    double beyond_nats = 0.0;
};

// The function returns what it costs, in nats, that a parameter could be anywhere in its plausible range
// (likelihood/occam.hpp). The cost is at least half a nat.
double occam_cost_nats(const EffectParam& param, double value, double sd);
// The same of several parameters that are known together. `information`: the inverse of their covariance.
double joint_occam_cost_nats(std::span<const EffectParam* const> params, std::span<const double> values,
                             const Matrix& information);
// The information about values, from that about their logarithms.
Matrix information_of_values(const Matrix& of_logarithms, std::span<const double> values);
const EffectParam& param_of(const EffectDefinition& effect, std::string_view name);

// The function returns those single-axis fits that pay for themselves (the best one if none does), or the fit
// that several share where it has more evidence. `common_cost_nats`: the cost of parameters that single-axis
// fits have in common.
std::optional<Finding> best_of(const EffectDefinition& effect, const std::vector<AxesFit>& single,
                               double common_cost_nats, const std::optional<AxesFit>& shared);

}  // namespace gyrolog
