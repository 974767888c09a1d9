// How an effect is looked for.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "analysis/diagnose/finding.hpp"
#include "analysis/diagnose/likelihood/baseline.hpp"
#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/simulate/effect.hpp"

namespace gyrolog {

// Made once for a baseline; after that it does not change and any number of threads may ask it.
class EffectTest {
public:
    virtual ~EffectTest() = default;

    // The best that the effect can do for this observation beyond the baseline's model; no value where the
    // data have no trace of it (gain 0).
    virtual std::optional<Finding> find(const Observation& observation) const = 0;
};

// Null with a reason where the recording cannot show the effect: no temperature, no motion, too short.
struct MadeTest {
    std::unique_ptr<EffectTest> test;
    std::string untestable;  // why not; a clause without a full stop
};
using TestMaker = MadeTest (*)(const EffectDefinition& effect, std::shared_ptr<const Baseline> baseline);

}  // namespace gyrolog
