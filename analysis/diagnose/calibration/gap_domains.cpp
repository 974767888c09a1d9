#include "analysis/diagnose/calibration/gap_domains.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "analysis/numerics/distributions.hpp"

namespace gyrolog {

namespace {

constexpr double db_per_neper = 20.0 / std::numbers::ln10;  // of an amplitude

double as_it_is(double value) { return value; }
double in_degrees(double angle) { return angle * deg_per_rad; }
double deviation_dps(double log_deviation) { return std::exp(log_deviation) * deg_per_rad; }
double variance_dB(double log_variance) { return 0.5 * db_per_neper * log_variance; }
// The spectrum's numbers are cube roots of power ratios (Wilson and Hilferty), whose band may reach below
// zero.
double power_dB(double value) { return 1.5 * db_per_neper * std::log(std::max(1.0 + value / 3.0, 0.2)); }

double variance_ratio_dB(double cube_root_less_1) {
    return 1.5 * db_per_neper * std::log(std::max(1.0 + cube_root_less_1, 0.2));
}

// How a kind of curve is shown.
struct DomainLook {
    const char* name;
    const char* x_name;
    const char* y_name;
    double (*x)(double);
    double (*y)(double);
    bool log_x = false;
    bool log_y = false;
    bool over_mean = false;  // the simulations' mean is taken off
};

const char* const standard_deviations = "mean (its sd)";

DomainLook look_of(GapDomainKind kind) {
    switch (kind) {
        case GapDomainKind::allan:
            return {
                "Allan deviation", "averaging time (s)", "σ(τ) (deg/s)", as_it_is, deviation_dps, true, true};
        case GapDomainKind::spectrum:
            return {"spectrum", "frequency (Hz)", "over the model (dB)", as_it_is, power_dB, true, false};
        case GapDomainKind::narrow:
            return {"narrow lines", "frequency (Hz)", "excess (its sd)", as_it_is, as_it_is, true};
        case GapDomainKind::course:
            return {"noise over time", "time (s)", "over the model (dB)", as_it_is, variance_dB};
        case GapDomainKind::drift:
            return {"bias over time", "time (s)", standard_deviations, as_it_is, as_it_is};
        case GapDomainKind::amplitude:
            return {"tails", "standard deviations", "2√count over model", as_it_is, as_it_is, false, false,
                    true};
        case GapDomainKind::temperature:
            return {"temperature", "temperature (degC)", standard_deviations, as_it_is, as_it_is};
        case GapDomainKind::cross_axis:
            return {"correlation with ", "frequency (Hz)", "correlation (its sd)", as_it_is, as_it_is, true};
        case GapDomainKind::rate:
            return {"rate about ", "reference rate (deg/s)", standard_deviations, in_degrees, as_it_is};
        case GapDomainKind::rate_noise:
            return {"noise by rate", "reference rate (deg/s)", "over the model (dB)", in_degrees,
                    variance_dB};
        case GapDomainKind::repeats:
            return {"repeated samples", "lag (s)", "excess (its sd)", as_it_is, as_it_is};
        case GapDomainKind::memory:
            return {"bursts of noise", "length (s)",      "over the model (dB)",
                    as_it_is,          variance_ratio_dB, true};
        case GapDomainKind::rhythm:
            return {"rhythm of the noise", "period (s)", "excess (its sd)", as_it_is, as_it_is, true};
        case GapDomainKind::period:
            return {"what comes back", "period (s)", "excess (its sd)", as_it_is, as_it_is, true};
        case GapDomainKind::codes:
            return {"converter's codes", "1 each code, 2 even and odd", "excess (its sd)", as_it_is,
                    as_it_is};
        case GapDomainKind::gain_course:
            return {"gain over time", "time (s)", "excess (its sd)", as_it_is, as_it_is};
        case GapDomainKind::delay_course:
            return {"delay over time", "time (s)", "excess (its sd)", as_it_is, as_it_is};
        case GapDomainKind::acceleration:
            return {"change of the rate", "change of the rate (deg/s^2)", standard_deviations, in_degrees,
                    as_it_is};
    }
    return {};
}

std::string name_of(const GapCurve& curve, const DomainLook& look) {
    const bool names_other = curve.kind == GapDomainKind::cross_axis || curve.kind == GapDomainKind::rate;
    const bool is_also_of_each = curve.of_all_axes && curve.kind == GapDomainKind::memory;
    return (is_also_of_each ? "shared " : "") + std::string(look.name) +
           (names_other ? axis_names.at(curve.other) : "");
}

// Where the x of the points rise: the amplitudes end in a number that is none of them, at 0.
std::size_t points_of(const GapCurve& curve) {
    const auto end = std::ranges::is_sorted_until(curve.x);
    return std::min(static_cast<std::size_t>(end - curve.x.begin()), curve.value.size());
}

struct Band {
    std::vector<double> lo, hi;
    std::vector<bool> outside;
};

// `shift`: by point, added to the reference before it is shown.
Band band_of(const MeasuredGap& gap, std::size_t index, const std::vector<double>& shift, double width_sd,
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

std::vector<GapDomain> gap_domains(const MeasuredGap& before, const MeasuredGap* after,
                                   double band_probability) {
    const double width_sd = normal_quantile(0.5 * (1.0 + band_probability));
    const std::vector<double> surprises_before = surprises_nats(before.curves, before.reference);
    const std::vector<double> surprises_after =
        after != nullptr ? surprises_nats(after->curves, after->reference) : std::vector<double>();
    std::vector<GapDomain> domains;
    for (std::size_t c = 0; c < before.curves.size(); ++c) {
        const GapCurve& curve = before.curves[c];
        const DomainLook look = look_of(curve.kind);
        const std::size_t points = points_of(curve);
        std::vector<double> shift(points, 0.0);
        GapDomain domain;
        domain.name = name_of(curve, look);
        domain.x_name = look.x_name;
        domain.y_name = look.y_name;
        domain.log_x = look.log_x;
        domain.log_y = look.log_y;
        domain.axis = curve.axis;
        domain.of_all_axes = curve.of_all_axes;
        for (std::size_t i = 0; i < points; ++i) {
            domain.x.push_back(look.x(curve.x[i]));
            if (look.over_mean) { shift[i] = -before.reference.mean[c][i]; }
            domain.recording.push_back(look.y(curve.value[i] + shift[i]));
        }
        Band band = band_of(before, c, shift, width_sd, look.y);
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
            band = band_of(*after, c, shift, width_sd, look.y);
            domain.after_lo = std::move(band.lo);
            domain.after_hi = std::move(band.hi);
            domain.outside_after = std::move(band.outside);
            domain.gap_after = gap_of(after->curves[c], after->reference, c).distance;
            domain.surprise_after_nats = surprises_after[c];
        }
        domains.push_back(std::move(domain));
    }
    return domains;
}

}  // namespace gyrolog
