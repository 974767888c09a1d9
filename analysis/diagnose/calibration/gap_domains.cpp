#include "analysis/diagnose/calibration/gap_domains.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "analysis/numerics/distributions.hpp"

namespace gyrolog {

namespace {

std::string name_of(const GapCurve& curve) {
    const Measure& measure = *curve.measure;
    return (curve.of_all_axes ? measure.shared_name : "") + std::string(measure.name) +
           (measure.names_other ? axis_names.at(curve.other) : "");
}

struct Band {
    std::vector<double> lo, hi;
    std::vector<bool> outside;
};

// `shift`: by point, added to the reference before it is shown.
Band band_of(const JudgedCurves& gap, std::size_t index, const std::vector<double>& shift, double width_sd,
             double (*shown)(double)) {
    Band band;
    const GapCurve& curve = gap.curves[index];
    for (std::size_t i = 0; i < shift.size(); ++i) {
        const double mean = gap.reference.mean[index][i];
        const double width = width_sd * gap.reference.sd[index][i];
        band.lo.push_back(shown(mean + shift[i] - width));
        band.hi.push_back(shown(mean + shift[i] + width));
        band.outside.push_back(std::fabs(curve.value[i] - mean) > width);
    }
    return band;
}

}  // namespace

std::vector<GapDomain> gap_domains(const JudgedCurves& before, const JudgedCurves* after,
                                   double band_probability) {
    const double width_sd = normal_quantile(0.5 * (1.0 + band_probability));
    const std::vector<double> surprises_before = surprises_nats(before.curves, before.reference);
    const std::vector<double> surprises_after =
        after != nullptr ? surprises_nats(after->curves, after->reference) : std::vector<double>();
    const double standing_out_nats = stands_out_nats(before.curves);
    std::vector<GapDomain> domains;
    for (std::size_t c = 0; c < before.curves.size(); ++c) {
        const GapCurve& curve = before.curves[c];
        const Measure& measure = *curve.measure;
        const std::size_t points = curve.value.size();
        std::vector<double> shift(points, 0.0);
        GapDomain domain;
        domain.name = name_of(curve);
        domain.x_name = measure.x_name;
        domain.y_name = measure.y_name;
        domain.log_x = measure.log_x;
        domain.log_y = measure.log_y;
        domain.is_course = measure.is_course;
        domain.categories.assign(measure.categories.begin(), measure.categories.end());
        domain.axis = curve.axis;
        domain.of_all_axes = curve.of_all_axes;
        for (std::size_t i = 0; i < points; ++i) {
            domain.x.push_back(measure.shown_x(curve.x[i]));
            if (measure.over_mean) { shift[i] = -before.reference.mean[c][i]; }
            domain.recording.push_back(measure.shown_y(curve.value[i] + shift[i]));
        }
        Band band = band_of(before, c, shift, width_sd, measure.shown_y);
        domain.before_lo = std::move(band.lo);
        domain.before_hi = std::move(band.hi);
        domain.outside_before = std::move(band.outside);
        domain.gap_before = gap_of(curve, before.reference, c).distance;
        domain.surprise_before_nats = surprises_before[c];
        if (after != nullptr && c < after->curves.size() &&
            after->curves[c].value.size() == curve.value.size()) {
            for (std::size_t i = 0; i < points; ++i) {
                shift[i] += curve.value[i] - after->curves[c].value[i];
            }
            band = band_of(*after, c, shift, width_sd, measure.shown_y);
            domain.after_lo = std::move(band.lo);
            domain.after_hi = std::move(band.hi);
            domain.outside_after = std::move(band.outside);
            domain.gap_after = gap_of(after->curves[c], after->reference, c).distance;
            domain.surprise_after_nats = surprises_after[c];
        }
        domain.stands_out =
            std::max(domain.surprise_before_nats, domain.surprise_after_nats) >= standing_out_nats;
        domains.push_back(std::move(domain));
    }
    return domains;
}

}  // namespace gyrolog
