// A number of a recording against the same number of many simulations, or of another recording.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace gyrolog {

// Of the distribution about the mean. Against another recording there is no band, and nothing stands out.
struct ComparedNumber {
    double recording = 0.0;
    double other = 0.0;  // the simulations' median, or the other recording
    std::optional<double> lo, hi;
    double distance = 0.0;  // from the simulations' mean, in standard deviations
    bool stands_out = false;

    bool outside() const { return lo && (recording < *lo || recording > *hi); }
};

// How far a value lies from the mean of at least two, in standard deviations of one more value like them:
// Student's t with n - 1 degrees of freedom when they are normal. Infinite where they are all one other
// value.
double distance_from(std::span<const double> simulated, double value);

// The distance that one more normal value exceeds with this probability, on either side.
double distance_by_chance(std::size_t simulations, double probability);

// The band is compare_with_simulations()'s (compared_curve.hpp). Distances are between `evenly_scattered`
// values, a rising function that makes the simulations' nearly normal. A number that is not finite on either
// side has no distance.
ComparedNumber compare_number(double recording, std::vector<double> simulated,
                              double (*evenly_scattered)(double), double false_alarms);

}  // namespace gyrolog
