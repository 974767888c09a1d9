#include "analysis/diagnose/selection/nonparametric_alternatives.hpp"

#include <utility>

#include "analysis/diagnose/selection/motion_memory.hpp"
#include "analysis/diagnose/selection/repeating_course.hpp"
#include "analysis/diagnose/selection/spectral_hump.hpp"

namespace gyrolog {

namespace {

using FindRival = std::optional<NonparametricFit> (*)(const Observation& without, const Observation& with);

constexpr FindRival rivals[] = {find_repeating_course, find_spectral_hump, find_motion_memory};

}  // namespace

std::optional<NonparametricFit> best_nonparametric(const Observation& without, const Observation& with) {
    std::optional<NonparametricFit> best;
    for (const FindRival find : rivals) {
        std::optional<NonparametricFit> found = find(without, with);
        if (found && (!best || found->evidence_nats > best->evidence_nats)) { best = std::move(found); }
    }
    return best;
}

}  // namespace gyrolog
