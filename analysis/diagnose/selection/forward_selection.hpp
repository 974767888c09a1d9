// Which effects, alone or together, a recording calls for.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/noise_refit.hpp"

namespace gyrolog {

// A recording under one model, and what every effect of the catalogue could do beyond it.
struct Hypotheses {
    std::shared_ptr<const Prediction> prediction;
    std::shared_ptr<const Observation> observation;
    std::vector<CatalogueEntry> catalogue;
    std::vector<std::optional<Finding>> findings;  // by entry of the catalogue

    const Finding* best() const;  // by evidence; null where there is none
};

// `seed` for what stands in holes.
Hypotheses examine(const std::shared_ptr<const Prediction>& prediction,
                   const std::shared_ptr<const Recording>& recording, std::uint64_t seed, unsigned threads);

struct FoundCause {
    Finding finding;
    // The findings of all effects with the other causes in the model, this one not: its rivals.
    std::vector<Finding> rivals;
};

// Of the main cause's evidence: two right formulas of one filter differ by as much.
inline constexpr double formulas_share = 5e-5;

// What effects seem to have beside the main cause.
struct NullBias {
    std::map<std::string, double> nats;  // by effect
    std::string beside;                  // the effect that is the main cause, empty without one
    std::vector<std::size_t> axes;       // the main cause's; other axes have no bias

    double of(const Finding& finding) const;
};

struct CauseSelection {
    std::vector<FoundCause> causes;        // by evidence
    std::vector<NoiseRefit> noise_refits;  // where the model that was given held part of the causes
    SensorModel without_causes;            // noise that held part of them is free
    SensorModel corrected;
    NullBias null_bias;  // was taken off the findings beside the main cause
    Hypotheses last;     // under the corrected model
};

struct SelectionOptions {
    double evidence_min_nats = 5.0;  // for a further cause
    std::size_t causes_most = 6;
    std::uint64_t seed = 1;
    unsigned threads = 0;
    std::function<bool(double)> on_progress{};  // false ends the work
};

// Greedily by evidence; after each new cause all are fitted again, one by one, with the others in the model,
// and those that the others made needless are dropped. `first` is under the model as it was given.
std::optional<CauseSelection> select_causes(const Hypotheses& first,
                                            const std::shared_ptr<const Recording>& recording,
                                            const SelectionOptions& options);

}  // namespace gyrolog
