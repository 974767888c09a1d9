// Which units of an array can be trusted at a sample.
//
//   missing    NaN
//   stuck      the same value for longer than the unit's own noise lets it repeat
//   saturated  at or beyond the unit's limit
//   noisy      its distance from the median of the units, each less its offset, is more than 8 of its
//   standard
//              deviations, or their mean square over 128 samples is more than four times what it should be;
//              it is trusted again below twice. A bias that jumps looks the same, and stays left out.
//
// To tell which unit is noisy takes three that work; that it is quiet again, two others. Units that turn
// differ by their scale factors: up to 3 % of the rate (the tolerance of common MEMS gyros) is no noise.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/denoise/array_noise.hpp"

namespace gyrolog {

enum class UnitState : std::uint8_t { good, missing, stuck, saturated, noisy };
inline constexpr std::size_t unit_states = 5;

std::string_view name_of(UnitState state);

struct UnitLimits {
    double white_sd = 0.0;                                        // of a sample
    double saturation = std::numeric_limits<double>::infinity();  // of the size
    std::size_t repeats_most = 16;                                // equal samples in a row
};

// Equal samples in a row that a unit may have: chance repeats them with this share, and a longer run than the
// answer comes once in 10^12 runs. Infinite (the largest size_t) for a unit that repeats nearly always.
std::size_t repeats_allowed(double repeat_share);

class UnitWatch {
public:
    explicit UnitWatch(std::span<const UnitLimits> limits);

    // `offsets_known`: false while the filter is still finding them; then none is noisy.
    std::span<const UnitState> judge(std::span<const double> rates, std::span<const double> offsets,
                                     bool offsets_known);

private:
    struct Unit {
        UnitLimits limits;
        double last = std::numeric_limits<double>::quiet_NaN();
        std::size_t run = 0;
        double mean_square = 1.0;  // of the distance, by what it should be
        bool noisy = false;
    };

    void judge_alone(std::size_t i, double rate);
    struct Reference {
        std::size_t units = 0;  // 0: too few to tell of any
        double median = 0.0;
        double variance = 0.0;  // of the median
        bool tells_of_good = false;
    };
    Reference reference(std::span<const double> rates, std::span<const double> offsets);
    void judge_distances(std::span<const double> rates, std::span<const double> offsets);

    std::vector<Unit> units_;
    std::array<UnitState, units_max> states_{};
    std::array<double, units_max> sorted_{};
};

}  // namespace gyrolog
