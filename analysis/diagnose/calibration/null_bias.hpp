// The null bias of an effect is the evidence that it seems to have although nothing is behind it. Under a
// model that the likelihoods do not describe well, as one with a coarse converter, simulations of that very
// model show it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/estimators/hypotheses.hpp"

namespace gyrolog {

// The null bias beside one main cause.
struct NullBias {
    std::map<std::string, double> nats;  // by effect
    std::string beside;                  // the effect that is the main cause, empty without one
    std::vector<std::size_t> axes;       // the main cause's; other axes have no bias

    double of(const Finding& finding) const;
    // What a rival, found without a cause and less bias, gains by the cause's absence: its evidence less what
    // the same has beside all causes, which speaks for a further cause.
    double taken_over_nats(const Finding& rival, const Hypotheses& beside_all) const;
};

// The function returns, in nats and by effect, the mean of 16 simulations of the hypotheses' model and four
// standard deviations more, of the evidence above zero. `told` is called along the way; no value where it
// returned false.
std::optional<std::map<std::string, double>> null_bias_nats(const Hypotheses& hypotheses, std::uint64_t seed,
                                                            unsigned threads,
                                                            const std::function<bool()>& told);

}  // namespace gyrolog
