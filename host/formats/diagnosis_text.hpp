// A diagnosis for people, in the order in which one asks: the verdict in one line; whether there is a gap,
// and by what odds; how much of it is explained, and by what, a row of a table for each cause; what is left,
// and where; what to do next. Then what the causes are, in words, and what was compared. The details
// follow where they are wanted.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "host/formats/effect_words.hpp"
#include "host/formats/wording.hpp"

namespace gyrolog {

// "known: temp_lag on x explains the gap", "no gap: the recording could have come from the model"; no full
// stop. `of`: what was diagnosed.
std::string verdict_sentence(const Diagnosis& diagnosis, std::string_view of = "recording");
// The same with the causes' sizes where that fits a line of a terminal: "known: tone on y (31.4 Hz, 0.00933
// deg/s) explains the gap".
std::string verdict_line(const Diagnosis& diagnosis, std::string_view of = "recording");
// The same without the causes' names where they are several: "known: 3 causes explain the gap".
std::string short_verdict_sentence(const Diagnosis& diagnosis, std::string_view of = "recording");

// Of a diagnosis with passes: "looked at the first 20 min sample by sample and at all of it in means of ...".
std::string passes_text(const Diagnosis& diagnosis);

// What the text says, sentence by sentence, for other forms of it.
struct DiagnosisSentences {
    struct OfCause {
        std::string effect;
        std::vector<CauseSize> sizes;
        std::string share;        // of the gap: "62 % (55 to 68)"
        std::string probability;  // "91 %"
        std::string words;        // what it is, and what cannot be told from it
    };

    std::string heading;    // what was held against what
    std::string gap;        // by what odds, how large, where
    std::string explained;  // how much, and on which data that was measured
    std::vector<OfCause> causes;
    std::string left;  // how much
    std::vector<std::string> left_items;
};
// Without a gap nothing is explained and nothing is left.
DiagnosisSentences diagnosis_sentences(const Diagnosis& diagnosis);

// Sentences: what one can do with the answer as it is, and the recordings that would tell more.
std::vector<std::string> next_sentences(const Diagnosis& diagnosis, std::string_view of = "recording");

// `whole`: with every parameter, place, rival and effect that could not be tested.
std::string diagnosis_text(const Diagnosis& diagnosis, Wording wording = Wording::whole);
// Of two sensors of one recording, and the effects that both have at the same place.
std::string diagnosis_text(const Diagnosis& gyro, const Diagnosis& accelerometer,
                           const std::vector<std::string>& shared, Wording wording = Wording::whole);

}  // namespace gyrolog
