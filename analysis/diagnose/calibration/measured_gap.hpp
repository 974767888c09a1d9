// The measured gap tells by simulation how far a recording is from a model, from the model with causes in it,
// and from that with one cause left out again.
//
// The surprisal of a recording under a model is the sum, over the measures, of -ln of the probability that a
// simulation of the model is as far off (calibration/gap_reference.hpp), and over the causes' own direction:
// of all the curves' points together, weighted as a cause changes them. The gap is the root of the
// recording's surprisal over a simulation's: for small differences both grow as a distance's square.
//
// Data judge what other data were fitted to: each half of a recording what the other half says of the causes,
// or a second recording what the first says.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/calibration/resolutions.hpp"
#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/report.hpp"
#include "analysis/simulate/random_purpose.hpp"

namespace gyrolog {

// A fold is a part of the data that judges, with the causes and the forms without a name as the other part
// has them.
struct Fold {
    std::shared_ptr<const Prediction> given;  // of the model that was given, for the part that judges
    std::vector<std::optional<Finding>> causes;
};

struct GapTrial {
    std::shared_ptr<const Recording> recording;  // that the folds are parts of
    std::vector<Fold> folds;                     // of one world
    SensorModel without_causes;                  // the corrected model without causes and forms
    // As the whole of the data that were fitted has them: the causes, then the forms without a name.
    std::vector<Finding> causes;
    // Evidence in the time stamps beyond a model: simulations copy stamps, so that no curve shows it.
    double stamps_before_nats = 0.0;
    double stamps_named_nats = 0.0;
    std::size_t unnamed = 0;  // how many of `causes` are forms without a name
};

struct MeasuredGapOptions {
    // Of the corrected model.
    std::size_t simulations = resolution::simulations_for_floor;
    // Of every other model, each with the draws of one of those.
    std::size_t paired_simulations = resolution::paired_simulations;
    std::uint64_t seed = 1;
    unsigned threads = 0;
    std::function<bool(double)> on_progress{};  // with the share that is done; false ends the work
};

struct MeasuredGap {
    Gap before, named;
    // That before, as one that is known to be there: no less than the floor and its standard deviation. The
    // judgement rests on more than this measure, in which a gap may drown. Where every cause is an event of
    // other data than those that judge, no gap is known to be there. All shares are of it.
    Gap judged;
    Gap after;  // with the forms without a name; `named` where there are none
    Share shrink;
    Share shrink_modelled;               // with those forms
    std::vector<Share> shares;           // by cause or form
    std::vector<double> returning_nats;  // by cause or form: the surprisal that returns without it
    double floor_nats = 0.0;             // a simulation's surprisal
    double excess_nats = 0.0;            // of the judged gap, beyond that; its standard deviation at least
};

// The function returns no value when ended early.
std::optional<MeasuredGap> measure_gap(const GapTrial& trial, const MeasuredGapOptions& options);

}  // namespace gyrolog
