// Flicker (1/f) noise, streaming and stationary from its first sample.
//
// Two-sided S(f) = B^2 / (2 pi f). In units of the sample rate, S(f) fs = B^2 / (2 pi nu) with nu = f / fs:
// the sampled process has the same statistics at every rate, so no rate appears here.
//
// Construction: a sum of first-order Gauss-Markov processes whose correlation times grow by 4 (the classic
// superposition of relaxations, M. S. Keshner, Proc. IEEE 70 (1982) 212-218). One runs at the sample rate;
// all others are the same process on grids 4, 16, 64, ... samples apart, joined by straight lines, so the
// slow ones cost nothing: 4/3 random draws a sample. Each starts from its stationary distribution. A
// symmetric three-point filter corrects the sum near the Nyquist frequency. The five constants minimise the
// largest error of expected_psd() against 1/nu.
//
// Accuracy: within 3.5 % of 1/f (0.15 dB) from slowest_frequency() to 0.49 cycles per sample, 4.5 % at
// Nyquist.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {

class FlickerNoise {
public:
    // One stream a level. More levels reach lower frequencies: 17 reach one cycle in 10^10 samples, which is
    // five months at 1 kHz.
    static constexpr unsigned default_levels = 17;

    // `streams`: of the full-rate process first, then of each slower one; two at least.
    FlickerNoise(double B_rad_per_s, std::vector<RandomStream> streams);

    // Adds the next samples to `out`.
    void add_next(std::span<double> out);

    // Cycles per sample above which 1/f holds, for this number of levels.
    static double slowest_frequency(unsigned levels);
    // The exact spectrum of this construction at nu cycles per sample for B = 1, averaged over the grids'
    // phases.
    static double expected_psd(double nu, unsigned levels);

private:
    // One Gauss-Markov process plus the straight lines between the values of the level above it.
    struct Level {
        RandomStream stream;
        double state = 0.0;
        std::uint64_t position = 0;  // values produced
        double knot_before = 0.0;    // of the slower level, around `position`
        double knot_after = 0.0;
    };

    void produce(std::size_t level, std::span<double> out);
    void add_slower(std::size_t level, std::uint64_t first, std::span<double> out);

    double B_rad_per_s_;
    std::vector<Level> levels_;
    double before_last_ = 0.0;  // the filter's memory
    double last_ = 0.0;
};

}  // namespace gyrolog
