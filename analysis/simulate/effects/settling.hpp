// exp(-t / tau) from the first sample on.
#pragma once

#include <algorithm>
#include <cstdint>

#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

class Settling {
public:
    explicit Settling(double tau_samples) : per_sample_(1.0 / tau_samples), left_after_one_(left_at(1)) {}

    // What is left at sample `index`.
    double left_at(std::uint64_t index) const {
        return portable_exp(-std::min(static_cast<double>(index) * per_sample_, 700.0));
    }
    // The factor from each sample to the next.
    double left_after_one() const { return left_after_one_; }

private:
    double per_sample_;
    double left_after_one_;
};

}  // namespace gyrolog
