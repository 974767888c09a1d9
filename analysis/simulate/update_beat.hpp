// A sensor that is polled faster than it updates shows each reading until the next: its samples repeat in a
// beat.
//
// Sample k shows update floor(x(k)), x(k) = k (1 - eps) + phase. That update was made when x passed the
// whole number, so that the sample is (x - floor(x)) / (1 - eps) samples old.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

class UpdateBeat {
public:
    struct Knot {
        double sample = 0.0;
        double phase = 0.0;
    };

    // A steady phase. `eps` is below 1.
    UpdateBeat(double eps, double phase) : eps_(eps), knots_{{0.0, phase}} {}
    // As read from `repeats` samples: a phase that wanders, straight between the knots; they ascend, and
    // there is one at least.
    UpdateBeat(double eps, std::vector<Knot> knots, std::size_t repeats)
        : eps_(eps), knots_(std::move(knots)), repeats_(repeats) {}

    // The share of the samples that repeat.
    double eps() const { return eps_; }
    std::size_t repeats() const { return repeats_; }

    struct Update {
        double number = 0.0;  // whole
        double age_samples = 0.0;
    };
    // What sample k shows.
    Update at(std::uint64_t k) const;

private:
    double eps_;
    std::vector<Knot> knots_;
    std::size_t repeats_ = 0;
};

// The beat in which a recording repeats: most rows that repeat the one before, in all gyro axes at once, come
// 1 / eps samples apart. Samples count on the recording's grid from its first row. The phase is that of
// groups of 64 repeats or more (of eight where there are few), so that it follows two clocks that drift
// against each other; chance repeats, which have no phase, only scatter it. Empty where samples repeat at
// random, hardly ever or nearly always.
//
// eps maximises the periodogram of the repeats' times (Schuster 1898) up to the share of rows that repeat.
std::optional<UpdateBeat> recorded_beat(const Recording& recording);

}  // namespace gyrolog
