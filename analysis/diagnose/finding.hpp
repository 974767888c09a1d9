// What a recording says for one effect.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct Span {
    double from = 0.0;
    double to = 0.0;
};

// Where a gap lies; what does not apply is empty.
struct Place {
    std::vector<std::size_t> axes;  // 0, 1, 2
    std::optional<Span> freq_hz;
    std::optional<Span> tau_s;
    std::optional<Span> time_s;  // from the recording's first sample; equal for an instant
    bool temperature = false;
    bool acceleration = false;
    std::optional<Span> rate_rad_s;  // of the size of the reference rate
    std::optional<Span> amplitude_sigma;
    std::string structure;  // "duplicated_samples", "timestamp_gaps", ...: diagnosis.md
};

struct Finding {
    std::string effect;
    // To be added to the model: one entry for all axes that share their parameters. Units are the effect's.
    std::vector<EffectModel> entries;
    std::vector<std::map<std::string, double>> sd;  // of entries' parameters, those that were fitted
    // Maximum of the log-likelihood with the effect, nuisance refitted, less that without it, in nats.
    double gain_nats = 0.0;
    // Log Bayes factor against the model as it is: the gain less what the freedom of the parameters earns by
    // chance (Laplace's approximation, with the effect's plausible ranges as prior). Below 0: not called for.
    double evidence_nats = 0.0;
    int parameters = 0;  // fitted
    std::array<double, 3> axis_gain_nats{};
    Place where;
};

// The model with one more cause.
SensorModel with_cause(SensorModel model, const Finding& finding);

// A noise coefficient of the model that the recording has otherwise, now that the causes are in the model. In
// SI units of the two-sided convention.
struct NoiseRefit {
    std::size_t axis = 0;
    char coefficient = 'N';  // 'N', 'B', 'K'
    double stated = 0.0;
    double fitted = 0.0;
    double fitted_sd = 0.0;
};

// ln of the Occam factor of one parameter known to +-sd a posteriori, uniform over `range` a priori: what it
// costs, at least half a nat.
double parameter_cost_nats(double range, double sd);

}  // namespace gyrolog
