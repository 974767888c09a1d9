#include "analysis/allan/averaging_factors.hpp"

#include <bit>

#include "analysis/numerics/power_comparison.hpp"

namespace gyrolog {

std::vector<std::int64_t> averaging_factors(std::int64_t samples) {
    if (samples < 2) { return {}; }
    constexpr unsigned intervals = 99;
    const auto octaves = static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(samples / 2)) - 1);
    std::vector<std::int64_t> factors;
    for (unsigned i = 0; i <= intervals; ++i) {
        // The smallest m with m^99 >= 2^(octaves i).
        std::int64_t low = factors.empty() ? 1 : factors.back();
        std::int64_t high = std::int64_t{1} << octaves;
        while (low < high) {
            const std::int64_t middle = low + (high - low) / 2;
            if (power_reaches(static_cast<std::uint64_t>(middle), intervals, octaves * i)) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        if (factors.empty() || low > factors.back()) { factors.push_back(low); }
    }
    return factors;
}

}  // namespace gyrolog
