#include "analysis/diagnose/calibration/gap_places.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>

namespace gyrolog {

namespace {

struct JudgedCurve {
    const GapCurve* curve = nullptr;
    CurveDistance distance;
    double surprise_nats = 0.0;  // its own or that of all axes together
    bool stands_out = false;
};

std::vector<JudgedCurve> judged(const std::vector<GapCurve>& curves, const GapReference& reference) {
    const std::vector<double> surprises = surprises_nats(curves, reference);
    const double standing_out_nats = stands_out_nats(curves);
    std::vector<JudgedCurve> all;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        all.push_back(
            {&curves[c], gap_of(curves[c], reference, c), surprises[c], surprises[c] >= standing_out_nats});
    }
    return all;
}

auto rank(const JudgedCurve& one) { return std::pair(one.surprise_nats, one.distance.surprise_nats); }

Place place_of(const JudgedCurve& worst, const std::vector<JudgedCurve>& all) {
    Place where;
    for (const JudgedCurve& one : all) {
        if (worst.curve->of_all_axes) { where.axes.push_back(one.curve->axis); }
        if (one.curve->measure != worst.curve->measure || one.curve->of_all_axes) { continue; }
        if (one.stands_out) { where.axes.push_back(one.curve->axis); }
    }
    if (where.axes.empty()) { where.axes.push_back(worst.curve->axis); }
    std::ranges::sort(where.axes);
    where.axes.erase(std::unique(where.axes.begin(), where.axes.end()), where.axes.end());
    worst.curve->measure->locate(*worst.curve, worst.distance.z, where);
    return where;
}

}  // namespace

Place farthest_place(const std::vector<GapCurve>& curves, const GapReference& reference) {
    const std::vector<JudgedCurve> all = judged(curves, reference);
    return place_of(*std::ranges::max_element(all, {}, rank), all);
}

std::vector<Left> places_that_stand_out(const std::vector<GapCurve>& curves, const GapReference& reference) {
    const std::vector<JudgedCurve> all = judged(curves, reference);
    std::vector<const JudgedCurve*> worst_of_measure;
    for (const JudgedCurve& one : all) {
        if (!one.stands_out) { continue; }
        const auto same = std::ranges::find(worst_of_measure, one.curve->measure,
                                            [](const JudgedCurve* other) { return other->curve->measure; });
        if (same == worst_of_measure.end()) {
            worst_of_measure.push_back(&one);
        } else if (rank(**same) < rank(one)) {
            *same = &one;
        }
    }
    std::vector<Left> places;
    places.reserve(worst_of_measure.size());
    for (const JudgedCurve* worst : worst_of_measure) {
        places.push_back({place_of(*worst, all), worst->distance.distance});
    }
    std::ranges::stable_sort(places, std::greater{}, &Left::size);
    return places;
}

}  // namespace gyrolog
