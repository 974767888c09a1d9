// A diagnosis for people, in the order in which one asks: the verdict in one line; whether there is a gap,
// and by what odds; how much of it is explained, by what, how surely, a line for each cause; what is left,
// and where; which recording would tell more. The details follow.
#pragma once

#include <string>
#include <string_view>

#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// "known: temp_lag on x explains the gap", "no gap: the recording could have come from the model"; no full
// stop. `of`: what was diagnosed.
std::string verdict_sentence(const Diagnosis& diagnosis, std::string_view of = "recording");
// The same without the causes' names where they are several: "known: 3 causes explain the gap".
std::string short_verdict_sentence(const Diagnosis& diagnosis, std::string_view of = "recording");

// Of a diagnosis with passes: "looked at the first 20 min sample by sample and at all of it in means of ...".
std::string passes_text(const Diagnosis& diagnosis);

std::string diagnosis_text(const Diagnosis& diagnosis);

}  // namespace gyrolog
