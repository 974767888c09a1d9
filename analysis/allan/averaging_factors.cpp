#include "analysis/allan/averaging_factors.hpp"

#include <bit>

#include <boost/multiprecision/cpp_int.hpp>

namespace gyrolog {

std::vector<std::int64_t> averaging_factors(std::int64_t samples) {
    if (samples < 2) { return {}; }
    // Without expression templates: pow() then returns a number, not an expression of temporaries.
    namespace mp = boost::multiprecision;
    using WholeNumber = mp::number<mp::cpp_int_backend<>, mp::et_off>;
    constexpr unsigned intervals = 99;
    const auto octaves = static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(samples / 2)) - 1);
    std::vector<std::int64_t> factors;
    for (unsigned i = 0; i <= intervals; ++i) {
        // The smallest m with m^99 >= 2^(octaves i).
        const WholeNumber bound = WholeNumber(1) << (octaves * i);
        std::int64_t low = factors.empty() ? 1 : factors.back();
        std::int64_t high = std::int64_t{1} << octaves;
        while (low < high) {
            const std::int64_t middle = low + (high - low) / 2;
            if (pow(WholeNumber(middle), intervals) >= bound) {
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
