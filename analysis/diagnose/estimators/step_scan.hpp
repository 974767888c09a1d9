// The step scan is least squares of a jump in the lowest cosine coefficients of a record, at many moments at
// once.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/numerics/cosine_transform.hpp"

namespace gyrolog {

// What a jump of height 1 before sample `at` (any real number) puts into coefficient k > 0.
double step_coefficient(std::size_t length, double at, std::size_t k);

class StepScan {
public:
    // The scan takes coefficients 1 ... `used` of a record of `length` samples, at twice as many moments.
    StepScan(std::size_t length, std::size_t used);

    std::size_t used() const { return used_; }
    std::size_t places() const { return 2 * used_; }
    double sample_at(std::size_t place) const;  // the moment, in samples
    double spacing() const;                     // of moments, in samples

    struct Fit {
        std::vector<double> pull;         // by place: sum of g Y / (mean square of Y)
        std::vector<double> information;  // sum of g^2 / (mean square of Y)

        double height(std::size_t place) const { return pull[place] / information[place]; }
        double gain_nats(std::size_t place) const {
            return 0.5 * pull[place] * pull[place] / information[place];
        }
    };
    // `weights`: 1 / mean square of coefficients 1, 2, ...; as many as are used.
    Fit fit(std::span<const float> cosines, std::span<const double> weights);

private:
    std::size_t length_;
    std::size_t used_;
    CosineTransform transform_;
};

}  // namespace gyrolog
