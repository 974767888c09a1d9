// Events that come independently of each other: a Poisson process on the axis of samples.
#pragma once

#include "analysis/simulate/counter_random.hpp"
#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

class Arrivals {
public:
    // `per_sample`: their mean number, above zero.
    Arrivals(const RandomStream& gaps, double per_sample) : gaps_(gaps), mean_gap_(1.0 / per_sample) {
        next();
    }

    // The number of this event and its place, both from zero.
    std::uint64_t number() const { return number_; }
    std::uint64_t sample() const { return static_cast<std::uint64_t>(place_); }
    void next() {
        number_ = drawn_++;
        place_ -= mean_gap_ * portable_log(gaps_.uniform(number_));
    }

private:
    RandomStream gaps_;
    double mean_gap_;
    std::uint64_t drawn_ = 0;
    std::uint64_t number_ = 0;
    double place_ = 0.0;
};

}  // namespace gyrolog
