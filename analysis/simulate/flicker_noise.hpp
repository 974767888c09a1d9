// Flicker (1/f) noise, streaming and stationary from its first sample.
//
// Two-sided S(f) = B^2 / (2 pi f). In units of the sample rate, S(f) fs = B^2 / (2 pi nu) with nu = f / fs:
// the sampled process has the same statistics at every rate, so no rate appears here.
//
// Construction: a sum of first-order Gauss-Markov processes whose correlation times grow by 4 (the classic
// superposition of relaxations, M. S. Keshner, Proc. IEEE 70 (1982) 212-218). Two run at the sample rate; all
// others are the same process on grids 4, 16, 64, ... samples apart, joined by straight lines, so the slow
// ones cost nothing: 7/3 random draws a sample. Each starts from its stationary distribution, and each grid
// from a random place, so that no sample is unlike another before it is drawn. A symmetric
// three-point filter corrects the sum near the Nyquist frequency. The constants minimise the largest error of
// expected_psd() against 1/nu, with the correlation on the grids held at 0.8: the closer their points follow
// each other, the less the straight lines show.
//
// Accuracy of the spectrum: within 0.5 % of 1/f from slowest_frequency() to a thousandth of the sample
// rate, 3.7 % (0.16 dB) up to 0.49 of it, 4.7 % at the Nyquist frequency. Over seeds that is all there is to
// know. Within one realisation, whose grids stay where they are, the variance of averages that are aligned
// with a grid differs from that of others by up to 3 %: 1.5 % in a deviation at tau of 4^n samples.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {

class FlickerNoise {
public:
    // One stream a process. More processes reach lower frequencies: 18 reach one cycle in 5 * 10^9 samples,
    // which is two months at 1 kHz.
    static constexpr unsigned default_processes = 18;

    // `streams`: of the two full-rate processes first, then of each slower one; three at least.
    FlickerNoise(double B_rad_per_s, std::span<const RandomStream> streams);

    // Adds the next samples to `out`.
    void add_next(std::span<double> out);

    // Cycles per sample above which 1/f holds, for this number of processes.
    static double slowest_frequency(unsigned processes);
    // The exact spectrum of this construction at nu cycles per sample for B = 1.
    static double expected_psd(double nu, unsigned processes);

private:
    struct GaussMarkov {
        double correlation;  // from one value to the next on the process's own grid
        double variance;     // for B = 1
    };
    static constexpr GaussMarkov fastest = {0.042384, 0.859514};
    static constexpr GaussMarkov fast = {0.778511, 0.572925};
    static constexpr GaussMarkov slower = {0.8, 0.473};

    // Turns standard normal draws into the process's values.
    struct Recursion {
        explicit Recursion(const GaussMarkov& kind);
        double start(double draw) { return value = sd * draw; }
        double next(double draw) { return value = correlation * value + innovation * draw; }

        double correlation;
        double sd;
        double innovation;
        double value = 0.0;
    };
    // Values are asked for in order, without a gap.
    struct Process {
        RandomStream stream;
        Recursion recursion;

        void produce(std::uint64_t first, std::span<double> out);
    };
    // A slower process plus the straight lines between the values of the level above it.
    struct Level {
        Process process;
        std::uint64_t position = 0;  // values produced
        std::uint64_t offset = 0;    // of the first value from a knot
        double knot_before = 0.0;    // of the next slower level, the last one at or before `position`
        double knot_after = 0.0;     // the one that follows it
    };

    static double psd_of(const GaussMarkov& process, double phase);
    void produce(std::size_t level, std::span<double> out);
    void produce_fastest(std::uint64_t first, std::span<double> out);
    void add_slower(std::size_t level, std::uint64_t first, std::span<double> out);

    double B_rad_per_s_;
    Process fastest_;
    std::vector<Level> levels_;  // the first one at the sample rate
    double before_last_ = 0.0;   // the filter's memory
    double last_ = 0.0;
};

}  // namespace gyrolog
