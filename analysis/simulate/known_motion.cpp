#include "analysis/simulate/known_motion.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "analysis/simulate/recorded_world.hpp"

namespace gyrolog {
namespace {

// True `margin` rows before, at and after every true one.
std::vector<bool> widened(const std::vector<bool>& marked, std::size_t margin) {
    std::vector<bool> wide(marked.size(), false);
    std::size_t marked_until = 0;
    for (std::size_t row = 0; row < marked.size(); ++row) {
        if (!marked[row]) { continue; }
        const std::size_t first = std::max(marked_until, row - std::min(row, margin));
        marked_until = std::min(row + margin + 1, marked.size());
        std::fill(wide.begin() + static_cast<std::ptrdiff_t>(first),
                  wide.begin() + static_cast<std::ptrdiff_t>(marked_until), true);
    }
    return wide;
}

}  // namespace

Recording with_known_motion(Recording recording, const KnownMotionOptions& options) {
    if (!has_reference(recording)) { return recording; }
    const auto shared = std::make_shared<const Recording>(std::move(recording));
    const std::vector<bool> unknown = RecordedWorld(shared).is_long_unknown();
    if (unknown.empty()) { return *shared; }
    const auto margin = static_cast<std::size_t>(std::ceil(options.memory_s * shared->rate_hz));
    const std::vector<bool> left_out = widened(unknown, margin);
    Recording known =
        rows_of(*shared, segments_where(shared->segments, [&](std::size_t row) { return !left_out[row]; }));
    std::ostringstream warning;
    warning << "the reference rate is not known in " << std::ranges::count(unknown, true) << " of "
            << shared->rows() << " samples for longer than a moment: they, and " << options.memory_s
            << " s on either side, are left out";
    known.warnings.push_back(warning.str());
    return known;
}

}  // namespace gyrolog
