#include "analysis/recording/grid_step.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

namespace gyrolog {
namespace {

// A converter's steps are looked for among so many different values at most.
constexpr std::size_t most_steps = 1U << 16U;

// Values on a grid come again and again: of most of them this tells sooner than a tree that they are known.
class RecentValues {
public:
    RecentValues() { by_hash_.fill(std::numeric_limits<double>::quiet_NaN()); }

    // Whether the value was among the last; it is from now on.
    bool had(double value) {
        constexpr std::uint64_t golden_ratio =
            0x9E3779B97F4A7C15U;  // Knuth 1998, 6.4: multiplicative hashing
        double& place = by_hash_[(std::bit_cast<std::uint64_t>(value) * golden_ratio) >> (64 - bits)];
        return std::exchange(place, value) == value;
    }

private:
    static constexpr unsigned bits = 10;  // of an index: 8 KiB of values, which stay in the nearest cache
    std::array<double, std::size_t{1} << bits> by_hash_{};
};

}  // namespace

double grid_step(std::span<const double> values) {
    constexpr std::size_t least_values = 4;
    std::set<double> different;
    RecentValues recent;
    for (const double value : values) {
        if (std::isnan(value) || recent.had(value)) { continue; }
        different.insert(value);
        // Values on a grid repeat: this many samples without are enough to know.
        if (different.size() > most_steps ||
            (different.size() > 1000 && different.size() * 2 > values.size())) {
            return 0.0;
        }
    }
    if (different.size() < least_values) { return 0.0; }
    double step = *different.rbegin() - *different.begin();
    for (auto low = different.begin(), high = std::next(low); high != different.end(); ++low, ++high) {
        step = std::min(step, *high - *low);
    }
    // The smallest distance carries the decimals' rounding; the whole range divides it out.
    const double range = *different.rbegin() - *different.begin();
    double refined = step;
    for (auto high = std::next(different.begin()); high != different.end(); ++high) {
        const double distance = *high - *different.begin();
        const double steps = std::round(distance / refined);
        if (std::abs(distance - steps * refined) > on_grid_tolerance * refined) { return 0.0; }
        refined = distance / steps;
    }
    return range / std::round(range / refined);
}

double grid_step(const Column& column) {
    const auto* reals = std::get_if<std::vector<double>>(&column.data);
    return std::abs(column.scale) * (reals != nullptr ? grid_step(*reals) : 1.0);
}

}  // namespace gyrolog
