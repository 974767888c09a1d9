#include "analysis/noise/clipping.hpp"

#include <algorithm>
#include <functional>

namespace gyrolog {
namespace {

constexpr double enough = 20.0;

// `further(a, b)`: a lies further out than b.
template <typename T, typename Further>
bool piles_up(const std::vector<T>& data, double alike, const Further& further) {
    const T end = *std::ranges::max_element(data, [&](T a, T b) { return further(b, a); });
    T beside = end;
    std::size_t at_end = 0;
    std::size_t at_beside = 0;
    bool third = false;
    for (const T x : data) {
        if (x == end) {
            ++at_end;
        } else if (at_beside > 0 && x == beside) {
            ++at_beside;
        } else {
            third = at_beside > 0;
            if (third && !further(x, beside)) { continue; }
            beside = x;
            at_beside = 1;
        }
    }
    return third && static_cast<double>(at_end) >= enough * alike && at_end > 2 * at_beside;
}

}  // namespace

bool is_clipped(const Column& column, double alike) {
    return std::visit(
        [&](const auto& data) {
            return !data.empty() &&
                   (piles_up(data, alike, std::greater<>()) || piles_up(data, alike, std::less<>()));
        },
        column.data);
}

}  // namespace gyrolog
