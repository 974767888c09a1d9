// A curve of a recording against the same curve of many simulations, or of another recording.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace gyrolog {

// Neighbouring points at which the recording lies outside, all on the same side.
struct OutsideRange {
    double from = 0.0;  // tau_s or f_hz
    double to = 0.0;
    double worst_at = 0.0;
    double worst_dB = 0.0;  // recording over the other; above 0 the recording is noisier
    std::size_t points = 0;
};

struct LargestGap {
    double at = 0.0;
    double dB = 0.0;        // recording over the other
    double distance = 0.0;  // in standard deviations
    bool stands_out = false;
};

// Amplitudes: 1 dB is a factor of 10^(1/20). All vectors are as long as `at`; points at which one of the
// curves has no positive value are left out.
struct ComparedCurve {
    std::vector<double> at;  // tau_s or f_hz, rising
    std::vector<double> recording;
    std::vector<double> recording_lo, recording_hi;  // its interval; empty against simulations
    std::vector<double> other;                       // the simulations' median, or the other recording
    std::vector<double> lo, hi;                      // their band, or its interval
    std::vector<OutsideRange> outside;
    double points_by_chance = 0.0;  // to be expected outside if the two were the same
    // How many simulations have as many points outside the band of the others as the recording.
    std::optional<std::size_t> simulations_outside_as_often;
    LargestGap gap;

    std::size_t points_outside() const;
    double ratio_dB(std::size_t point) const;  // recording over the other
};

// The band from the k-th smallest to the k-th largest of n simulations holds one more value of the same kind
// with probability 1 - 2 k / (n + 1) at each point (the rank of one among n + 1 exchangeable values is
// uniform). k is the largest with 95 % or more, or 1: of 39 simulations 95 % exactly, of 40 95.12 %, both by
// the smallest and the largest.
std::size_t band_rank(std::size_t simulations);
double band_probability(std::size_t simulations);

// `simulations`: each as long as `at`, at least three of them.
//
// The largest gap is where the recording's amplitude to the power 2/3 lies farthest from the mean of the
// simulations', in units of their scatter (as for one more value). It stands out when Student's t is as large
// with a probability below `false_alarms` over the number of points: on the safe side, for neighbouring
// points vary together. A guide to the eye, not a calibrated test.
ComparedCurve compare_with_simulations(std::span<const double> at, std::span<const double> recording,
                                       const std::vector<std::vector<double>>& simulations,
                                       double false_alarms = 0.05);

// A curve with its 68 % interval.
struct CurveWithInterval {
    std::vector<double> at, value, lo, hi;
};

// At the points of `recording`, with `other` interpolated. Outside: the intervals do not meet, which by
// chance, for errors of equal size, happens with probability P(|z| > sqrt 2) = 0.157 to 68.3 % intervals. The
// gap stands out likewise, by the normal distribution.
ComparedCurve compare_with_intervals(const CurveWithInterval& recording, const CurveWithInterval& other,
                                     double false_alarms = 0.05);

}  // namespace gyrolog
