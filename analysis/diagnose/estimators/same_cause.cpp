#include "analysis/diagnose/estimators/same_cause.hpp"

#include <optional>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"

namespace gyrolog {

namespace {

bool overlap(const std::optional<Span>& a, const std::optional<Span>& b, double apart) {
    return a && b && a->from <= b->to + apart && b->from <= a->to + apart;
}

}  // namespace

bool is_same_cause(const Finding& a, const Finding& b, double duration_s) {
    if (a.effect != b.effect) { return false; }
    if (!traits_of(a.effect).recurs) { return true; }
    const double near_hz = decisions.same_line_resolutions / duration_s;
    return overlap(a.where.freq_hz, b.where.freq_hz, near_hz) || overlap(a.where.time_s, b.where.time_s, 0.0);
}

}  // namespace gyrolog
