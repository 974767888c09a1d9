// Allan deviation of a signal that is still coming in: memory does not grow with its length.
//
// At m = 2^j samples, from differences of theta (allan_deviation.hpp) that begin at every s-th sample of the
// record's grid, s = max(1, m / 16):
//
//   sigma^2(m) = mean over k = 0, s, 2s, ... of (theta_{k+2m} - 2 theta_{k+m} + theta_k)^2 / (2 m^2)
//
// For m up to 16 that is the overlapping deviation itself (NIST SP 1065 eq. 11), above it the overlapping
// deviation of averages of s samples at 16 of them: each octave needs the last 33 points of theta only, each
// taken from every s-th sample. Differences a sixteenth of m apart share 15/16 of their span; what the ones
// in between would add to the degrees of freedom is below 1 % for white noise, less for what is redder. As
// there, a difference is used only where all its samples exist.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/allan/power_law_levels.hpp"

namespace gyrolog {

class RunningAllan {
public:
    // `index`: of the first of these consecutive samples on the record's grid of sampling instants. One that
    // is not the next leaves a hole behind it; one that goes back does too, and the grid goes on from there.
    void take(std::int64_t index, std::int16_t count);

    // One an octave, at every m that has a difference; the deviation in counts, no interval.
    std::vector<AllanPoint> points(double rate_hz) const;

    // The same in the samples' unit, `scale` a count, with intervals: those of intervals.hpp for an unbroken
    // record of as many samples, under the power laws fitted to these very points.
    struct Described {
        AllanCurve curve;
        PowerLawLevels laws;
    };
    Described describe(double rate_hz, double scale, double confidence = 0.683) const;

    std::uint64_t samples() const { return samples_; }

    static constexpr std::size_t octaves = 36;  // the longest: 2 m samples of 32 kHz are 49 days

private:
    static constexpr unsigned overlap_log2 = 4;
    static constexpr std::size_t overlap = std::size_t{1} << overlap_log2;  // differences begun every m / 16
    static constexpr std::size_t points_kept = 2 * overlap + 1;

    struct Octave {
        std::array<std::int64_t, points_kept> theta{};  // a ring
        std::size_t next = 0;
        std::size_t kept = 0;  // since the last hole
        double squares = 0.0;
        double squares_lost = 0.0;  // of rounding
        std::int64_t terms = 0;
    };

    void take_point();
    static void enter(Octave& octave, std::int64_t theta, std::size_t reach);

    std::vector<Octave> octaves_ = std::vector<Octave>(octaves);
    std::int64_t theta_ = 0;  // of the samples before `index_`
    // Of the next sample, at first of none. Unsigned: a board may tell any number, and goes on from the
    // largest one at 0.
    std::uint64_t index_ = ~std::uint64_t{0};
    std::uint64_t samples_ = 0;
};

}  // namespace gyrolog
