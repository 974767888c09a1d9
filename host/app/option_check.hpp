// What CLI11 checks about an option's text, told in our own words.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace gyrolog {

// A number from `lowest` to `highest`; `unit` ends the message: "must be from 0.0001 to 10000000 Hz".
CLI::Validator number_from_to(double lowest, double highest, const std::string& unit = "");

// Of a recording, in Hz.
CLI::Validator sampling_rate();

// More than 0, and finite.
CLI::Validator positive_number();

// Without a sign, a point or a loss: what does not fit is refused, not cut down to what does.
CLI::Validator whole_number(std::uint64_t lowest,
                            std::uint64_t highest = std::numeric_limits<std::uint64_t>::max());

// "90", "15m": what parse_duration_s() understands.
CLI::Validator duration();

// The same, or 0.
CLI::Validator duration_or_none();

// "500M", "2G": what parse_bytes() understands.
CLI::Validator size();

// Passes everything: the values that a shell offers of an option whose own check knows more, or says it
// better.
CLI::Validator offered(const std::vector<std::string>& values);
// Those of an option; empty: none.
std::vector<std::string> offered_values(CLI::Option& option);

// The same, or 0.
CLI::Validator size_or_none();

}  // namespace gyrolog
