#include "analysis/noise/clipping.hpp"

#include <algorithm>
#include <functional>

namespace gyrolog {
namespace {

constexpr std::size_t enough = 20;

// `further(a, b)`: a lies further out than b.
template <typename T, typename Further>
bool piles_up(const std::vector<T>& data, const Further& further) {
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
    return third && at_end >= enough && at_end > 2 * at_beside;
}

}  // namespace

bool is_clipped(const Column& column) {
    return std::visit(
        [](const auto& data) {
            return !data.empty() && (piles_up(data, std::greater<>()) || piles_up(data, std::less<>()));
        },
        column.data);
}

}  // namespace gyrolog
