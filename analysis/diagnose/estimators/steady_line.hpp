// A steady line is a sinusoid of any frequency and phase in the cosine coefficients of a record.
//
// With i + 1/2 the time in samples, w the angular frequency a sample, c = sqrt(2/n):
//   cos(w (i + 1/2)) -> Y_k = c/2 (D(w - t) + D(w + t)),  t = pi k/n
//   sin(w (i + 1/2)) -> Y_k = c/2 (E(w - t) + E(w + t))
//   D(a) = sin(n a) / (2 sin(a/2)),  E(a) = (1 - cos(n a)) / (2 sin(a/2))
// (sums of geometric series). The first falls off on both sides of k = w n/pi as a sinc, the second as 1/k:
// 64 coefficients on either side hold more than 99 % of either.
#pragma once

#include <cstddef>
#include <span>

namespace gyrolog {

// The line is cosine cos(w (i + 1/2)) + sine sin(w (i + 1/2)), at `place` = w n/pi in coefficients.
struct SteadyLine {
    double place = 0.0;
    double cosine = 0.0;
    double sine = 0.0;
};

class LineShape {
public:
    LineShape(std::size_t length, double place);

    struct Pair {
        double cosine;
        double sine;
    };
    // What either part puts into coefficient k, 0 < k < length.
    Pair at(std::size_t k) const;

private:
    double place_;
    double half_step_;  // pi / 2n
    double half_scale_;
    double sine_of_end_;  // sin and cos of n w
    double cosine_of_end_;
};

struct LineFit {
    SteadyLine line;
    double gain_nats = 0.0;
};

// The function fits a line at a given place by least squares. `cosines` and `weights`, 1 / mean square, are
// those of the coefficients first, first + 1, ...
LineFit fit_line(std::size_t length, double place, std::size_t first, std::span<const float> cosines,
                 std::span<const double> weights);

}  // namespace gyrolog
