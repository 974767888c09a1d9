// What CLI11 checks about an option's text, told in our own words.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace gyrolog {

// A number from `lowest` to `highest`; `unit` ends the message: "must be from 0.0001 to 10000000 Hz".
CLI::Validator number_from_to(double lowest, double highest, const std::string& unit = "");

// More than 0.
CLI::Validator positive_number();

// A whole number from 0 to 2^64 - 1.
CLI::Validator seed_number();

// A name that ends in .png: figures have no other form.
CLI::Validator png_file();

}  // namespace gyrolog
