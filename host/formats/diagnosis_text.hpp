// A diagnosis for people: the verdict first, in one line, then what it rests on, each cause with its numbers
// and what it cannot be told apart from, where the gap lies before and after, what could not be tested, and
// which recording would settle what is open.
#pragma once

#include <string>
#include <string_view>

#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// "known: temp_lag on x explains the gap", "no gap: the recording could have come from the model"; no full
// stop. `of`: what was diagnosed.
std::string verdict_sentence(const Diagnosis& diagnosis, std::string_view of = "recording");

// "x axis, averaging times 60 s to 15 min"; "" for a place without anything.
std::string place_text(const Place& place);

// Of a diagnosis with passes: "looked at the first 20 min sample by sample and at all of it in means of ...".
std::string passes_text(const Diagnosis& diagnosis);

std::string diagnosis_text(const Diagnosis& diagnosis);

}  // namespace gyrolog
