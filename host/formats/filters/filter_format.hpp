// The filters that a recording or a model can be exported to. A filter is one file, and one line in
// filter_format.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/formats/filters/filter_source.hpp"

namespace gyrolog {

// One number of a filter's file.
struct FilterNumber {
    std::string_view key;
    SensorKind sensor;
    NoiseTerm term;                                // N or K
    std::string_view unit;                         // of the number
    double (*of)(double density, double rate_hz);  // what the filter takes in the place of N or K
    double most = 0.0;                             // the filter takes a larger one for this; 0: no limit
};

struct FilterFormat {
    std::string_view name;     // of --for
    std::string_view summary;  // what is written
    std::string_view kind;  // continuous or discrete, and at which rate: a sentence; {rate} is the sensor's
    // How each number enters the filter's equations, and faults that a user has to know, each with where it
    // was read.
    std::span<const std::string_view> facts;
    std::span<const FilterNumber> numbers;
    std::string_view line;    // of a number: a pattern with {key} and {value}
    std::string_view before;  // what stands between the head and the numbers; with {rate}
    std::string_view after;
    std::string_view first{};    // what has to stand before the head
    std::string_view missing{};  // in the place of a number that is not known; with {key}
    // In the place of the four patterns where they do not do.
    std::string (*text)(const FilterSource& source) = nullptr;
};

std::span<const FilterFormat* const> filter_formats();

// Null for an unknown name.
const FilterFormat* find_filter_format(std::string_view name);

// The whole file. A number that is not identified is left out; a comment in its place says what it may be at
// most. With ExportSource::upper_limits it is that limit, and the head says so.
std::string filter_text(const FilterFormat& format, const ExportSource& source);

// What the file lacks, one sentence each: numbers that the source does not have.
std::vector<std::string> missing_numbers(const FilterFormat& format, const ExportSource& source);

// The keys of numbers for which the file has an upper limit (ExportSource::upper_limits): "a, b"; or empty.
std::string numbers_at_upper_limit(const FilterFormat& format, const ExportSource& source);

// A real number with a point, as readers of YAML 1.1 and OpenCV's want it: 3e-06 is a text to them, or 100 a
// whole number.
std::string real_text(double value);

}  // namespace gyrolog
