#include "analysis/spectrum/decimator.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace gyrolog {
namespace {

using std::numbers::pi;

using Taps = std::array<double, Decimator::taps>;

// Half of the outputs' Nyquist band is passed and what folds onto it stopped: transition from 0.3 to 0.7 of
// the output rate, 0.314 rad a sample, which at 100 dB takes 128 taps (Kaiser 1974).
Taps low_pass() {
    constexpr double attenuation_db = 100.0;
    constexpr double beta = 0.1102 * (attenuation_db - 8.7);
    constexpr double cutoff = 0.5 / Decimator::factor;  // cycles per input sample
    constexpr double middle = (Decimator::taps - 1) / 2.0;
    Taps h{};
    double sum = 0.0;
    for (std::size_t i = 0; i < h.size(); ++i) {
        const double t = static_cast<double>(i) - middle;  // never 0: the number of taps is even
        const double edge = t / middle;
        const double window = std::cyl_bessel_i(0.0, beta * std::sqrt(1.0 - edge * edge));
        h[i] = std::sin(2.0 * pi * cutoff * t) / t * window;
        sum += h[i];
    }
    for (double& tap : h) { tap /= sum; }
    return h;
}

const Taps& filter() {
    static const Taps h = low_pass();
    return h;
}

// Eight sums side by side, so that the compiler may use vector registers without reordering any of them.
double filtered(const double* x, const Taps& h) {
    std::array<double, 8> sums{};
    for (std::size_t i = 0; i < h.size(); i += sums.size()) {
        for (std::size_t j = 0; j < sums.size(); ++j) { sums[j] += h[i + j] * x[i + j]; }
    }
    double sum = 0.0;
    for (const double part : sums) { sum += part; }
    return sum;
}

}  // namespace

double Decimator::power_gain(double cycles_per_output) {
    const Taps& h = filter();
    const double omega = 2.0 * pi * cycles_per_output / factor;
    // cos((m + 1/2) omega) from the middle outwards by the recurrence of Chebyshev's polynomials: bins are
    // many.
    const double twice = 2.0 * std::cos(omega);
    double before = std::cos(0.5 * omega);
    double now = before;
    double gain = 0.0;
    for (std::size_t i = taps / 2; i-- > 0;) {
        gain += 2.0 * h[i] * now;
        before = std::exchange(now, twice * now - before);
    }
    return gain * gain;
}

void Decimator::push(std::span<const double> in, std::vector<double>& out) {
    const Taps& h = filter();
    pending_.insert(pending_.end(), in.begin(), in.end());
    out.clear();
    std::size_t first = 0;
    for (; first + taps <= pending_.size(); first += factor) {
        out.push_back(filtered(pending_.data() + first, h));
    }
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace gyrolog
