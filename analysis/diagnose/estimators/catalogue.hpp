// The catalogue has one row for each estimator: which evidence it is asked for, how it is made, and what is
// true of the effects that it finds. Nothing else in the diagnosis asks which estimator a finding comes from.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

// Samples that are off by more than noise has it.
enum class FarOff {
    none,
    single_samples,  // some, each by itself
    in_distribution  // as many as the noise's distribution has far out
};

struct EstimatorTraits {
    EvidenceMethod method = EvidenceMethod::response;
    FarOff far_off = FarOff::none;
    EstimatorMaker make = nullptr;
    // Normal noise of the same spectrum. Where that is a cause already, the effect is another one only by
    // what its likelihood has beside the spectra.
    std::string_view twin = {};
    // The effect changes the mean answer to the world.
    bool is_response = false;
    // It shows in the mean answer to the world or in the stamps, whatever the noise is. A jump does not:
    // noise that is slower than the model has it makes jumps.
    bool is_beside_noise = false;
    // The effect is noise, which takes up whatever is there. What tells it grows with the length of the
    // recording.
    bool is_noise = false;
    // The spectra's likelihood takes the effect for normal noise, which it is not: a telegraph's jumps are
    // steps that such noise does not have; the power of heavy tails and of spikes varies by more than its
    // does.
    bool is_not_normal = false;
    // With the effect in the model the spectra's likelihood is another one, which does not compare with that
    // of a model without it: of normal noise it is not, or of other samples, the effect's own left out.
    bool changes_likelihood = false;
    // What tells the effect is beside the spectra: in the samples' distribution, their codes, their stamps,
    // the course of their variance, what axes share.
    bool is_beside_spectra = false;
    // The effect is a steady line. Its phase is the recording's, not the model's.
    bool is_line = false;
    // The effect may be there more than once, each time with parameters of its own.
    bool recurs = false;
    // The effect is what the converter does to the numbers. Likelihoods of a continuous signal take it for
    // something else, in a simulation of it as well.
    bool is_of_codes = false;
    // The time stamps show the effect. Simulations copy them, so that only its own likelihood tells its
    // chance.
    bool is_in_stamps = false;
    // Means of samples show the effect as samples do. They do not where it is in the samples' distribution,
    // their codes or their stamps: a mean is no sample. A sample that is far enough off they show smaller.
    bool shows_in_means = true;
    // The effect is counted in the numbers: codes, repeated samples, gaps in the stamps. No noise is fitted
    // that could be fitted too well, so that its own evidence tells how likely it is, and data that the fit
    // did not use have nothing to add.
    bool is_counted = false;
    // The effect can be fitted to one half of a recording and judged by the other. What is counted needs
    // not. Two levels that the model has
    // already cannot be looked for again. A line lies in few coefficients, which may all be in one half; the
    // largest of some spikes or of clipped samples is no parameter that a second sample of them would share.
    bool can_be_halved = true;
};

// The functions return the row of the estimator that an effect's signature names, or, in the world of
// `prediction`, of the one that looks for it there: in a moving world the mean answer tells far more than the
// noise does. An effect that nothing looks for has a row without `make`.
const EstimatorTraits& traits_of(std::string_view effect);
const EstimatorTraits& traits_of(std::string_view effect, const Prediction& prediction);

// What folds, a mean takes off: whether means of samples show the effect as samples do.
bool shows_in_means(const EffectSignature& signature);

struct CatalogueEntry {
    const EffectDefinition* effect = nullptr;
    std::unique_ptr<Estimator> estimator;
    std::string untestable;  // why there is no estimator
};

// The function makes one effect's estimator. There is neither an estimator nor a reason where nothing looks
// for the effect.
MadeEstimator make_estimator(const EffectDefinition& effect,
                             const std::shared_ptr<const Prediction>& prediction);

// The function says why the recording cannot show the effect at all: no temperature, no reference rate, means
// of samples. It returns nothing where the recording may.
std::string untestable_in(const EffectDefinition& effect, const Prediction& prediction);

// The catalogue holds every effect that has a signature and a name of its own, in the order of the signal
// chain.
std::vector<CatalogueEntry> make_catalogue(const std::shared_ptr<const Prediction>& prediction,
                                           unsigned threads = 1);

}  // namespace gyrolog
