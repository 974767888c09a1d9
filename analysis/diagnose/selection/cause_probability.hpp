// A cause's probability compares it with whatever could stand in its place, the other causes in the model:
// another effect, a shape without a name, nothing. Before the recording was seen all were as likely. What
// else is left of the gap has no part in it.
#pragma once

#include <optional>

#include "analysis/diagnose/report.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"

namespace gyrolog {

// `found` is one of the selection's causes. A rival counts for what it gains by the cause's absence: what it
// has beside all causes is no reason against one. `returning_nats`: the surprisal that returns without the
// cause, on data that the fit did not use: its evidence against nothing. What is counted has evidence of its
// own.
Cause with_probability(const FoundCause& found, const CauseSelection& selection, double returning_nats,
                       const std::optional<BetterShape>& better_shape);

// The probability that the cause or one of its ties is right.
double probability_of_tie(const Cause& cause);

// What would settle the cause's tie: a sentence, empty where there is none.
std::string deciding_recording(const Cause& cause);

// Puts the length that would settle the tie into `decided_by`, where that has a place for it. Evidence grows
// with the time that is listened to: of `duration_s` it is what the first rival is behind.
void state_deciding_length(Cause& cause, double duration_s);

// How the sentence begins.
std::string telling_apart(const std::string& effect);

}  // namespace gyrolog
