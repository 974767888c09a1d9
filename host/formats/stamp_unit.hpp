// The unit of time stamps whose name does not tell it, from their size and their steps.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace gyrolog {

struct StampUnit {
    std::string_view name;  // "s", "ms", "us", "ns"
    double per_s;
};

// A division by `per_s` gives the nearest number of seconds, which a product with its inverse does not.
inline constexpr std::array stamp_units = {StampUnit{"s", 1.0}, StampUnit{"ms", 1e3}, StampUnit{"us", 1e6},
                                           StampUnit{"ns", 1e9}};

struct StampUnitOptions {
    // Rates that gyros are sampled at: from a logger that keeps a value every ten seconds to the fastest
    // output of a closed-loop optical gyro.
    double rate_least_hz = 0.1;
    double rate_most_hz = 40'000.0;
    // Stamps that count from 1970 tell their unit by their size: from 1990 to 2100.
    double epoch_least_s = 631'152'000.0;
    double epoch_most_s = 4'102'444'800.0;
};

struct StampUnits {
    std::vector<StampUnit> units;
    double step = 0.0;  // the median of a sample; 0: there are no two that rise
};

// The units in which the median step of the first stamps is a sampling period. Where several are, one in
// which the stamps are a date is meant alone; so are seconds where the steps are fractions of one, for who
// counts in smaller units counts whole ones. More than one is left: nobody can tell. None: these are no
// stamps of a gyro. Without two stamps that rise: seconds. `samples_per_row`: each stamp is the mean of so
// many.
StampUnits plausible_stamp_units(std::span<const double> stamps, double samples_per_row,
                                 const StampUnitOptions& options = {});

}  // namespace gyrolog
