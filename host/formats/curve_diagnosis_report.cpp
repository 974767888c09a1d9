#include "host/formats/curve_diagnosis_report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/formats/curve_effect.hpp"
#include "host/formats/diagnosis_json.hpp"
#include "host/formats/json.hpp"
#include "host/formats/noise_json.hpp"
#include "host/formats/noise_unit.hpp"

namespace gyrolog {
namespace {

constexpr double probability_in_band = 0.95;
constexpr double band_sd = 1.96;

double modelled_deviation(const std::vector<CurveTerm>& terms, double tau_s) {
    double variance = 0.0;
    for (const CurveTerm& term : terms) { variance += term.allan_variance(tau_s); }
    return std::sqrt(variance);
}

std::vector<CurveTerm> terms_of(const std::vector<ModelledTerm>& model) {
    std::vector<CurveTerm> terms;
    terms.reserve(model.size());
    for (const ModelledTerm& modelled : model) { terms.push_back(modelled.term); }
    return terms;
}

struct Band {
    std::vector<double> lo;
    std::vector<double> hi;
    std::vector<bool> outside;
};

Band band_of(const std::vector<CurveTerm>& terms, const GapDomain& domain, double reading_error) {
    Band band;
    const double factor = std::exp(band_sd * reading_error);
    for (std::size_t i = 0; i < domain.x.size(); ++i) {
        const double deviation = modelled_deviation(terms, domain.x[i]) * deg_per_rad;
        band.lo.push_back(deviation / factor);
        band.hi.push_back(deviation * factor);
        band.outside.push_back(domain.recording[i] < band.lo.back() || domain.recording[i] > band.hi.back());
    }
    return band;
}

GapDomain domain_of(const DiagnosedCurve& curve, double reading_error) {
    GapDomain domain;
    domain.name = "Allan deviation";
    domain.x_name = "averaging time (s)";
    domain.y_name = "σ(τ) (deg/s)";
    domain.log_x = domain.log_y = true;
    domain.axis = curve.axis;
    for (const AllanPoint& point : curve.curve.points) {
        if (!(point.deviation > 0.0 && point.tau_s > 0.0)) { continue; }
        domain.x.push_back(point.tau_s);
        domain.recording.push_back(point.deviation * deg_per_rad);
    }
    Band before = band_of(terms_of(curve.model), domain, reading_error);
    domain.before_lo = std::move(before.lo);
    domain.before_hi = std::move(before.hi);
    domain.outside_before = std::move(before.outside);
    domain.gap_before = curve.diagnosis.in_floors(curve.diagnosis.before);
    if (curve.diagnosis.causes.empty()) { return domain; }
    Band after = band_of(curve.diagnosis.corrected, domain, reading_error);
    domain.after_lo = std::move(after.lo);
    domain.after_hi = std::move(after.hi);
    domain.outside_after = std::move(after.outside);
    domain.gap_after = curve.diagnosis.in_floors(curve.diagnosis.after);
    return domain;
}

Span joined(const std::optional<Span>& span, double from, double to) {
    return span ? Span{std::min(span->from, from), std::max(span->to, to)} : Span{from, to};
}

// The square of a curve's gap beyond the floor, in floors.
double excess_of(const DiagnosedCurve& curve) {
    const double gap = curve.diagnosis.in_floors(curve.diagnosis.before);
    return std::max(gap * gap - 1.0, 0.0);
}

// `part`: of the gap of all curves, what this one has.
void put_cause(Diagnosis& diagnosis, const DiagnosedCurve& curve, const CurveCause& found, double part) {
    const CurveEffect effect = effect_of(found);
    auto cause = std::ranges::find_if(diagnosis.causes,
                                      [&](const Cause& c) { return c.finding.effect == effect.effect; });
    if (cause == diagnosis.causes.end()) {
        cause = diagnosis.causes.insert(diagnosis.causes.end(), Cause{});
        cause->finding.effect = effect.effect;
        cause->sense = found.is_of_model() ? Sense::model_has : Sense::recording_has;
    }
    cause->share.value = std::min(cause->share.value + part * found.share, 1.0);
    Finding& finding = cause->finding;
    const double gain_nats = 0.5 * found.criterion_gain;
    finding.entries.push_back({effect.effect, {axis_names.at(curve.axis)}, effect.params, ""});
    finding.sd.push_back(effect.sd);
    finding.gain_nats += gain_nats;
    finding.evidence_nats += gain_nats;
    std::vector<std::size_t>& axes = finding.where.axes;
    if (std::ranges::count(axes, curve.axis) == 0) { axes.push_back(curve.axis); }
    finding.where.tau_s = joined(finding.where.tau_s, found.from_tau_s, found.to_tau_s);
    const bool strongest = gain_nats >= *std::ranges::max_element(finding.axis_gain_nats);
    finding.axis_gain_nats.at(curve.axis) += gain_nats;
    if (!strongest) { return; }
    cause->score = found.probability;
    cause->tie_group.clear();
    cause->decided_by.clear();
    if (found.rivals.empty()) { return; }
    cause->tie_group.push_back({effect.effect, 0.0});
    for (const CurveRival& rival : found.rivals) {
        cause->tie_group.push_back({effect_name(rival.term.kind), 0.5 * rival.criterion_behind});
    }
    cause->decided_by = "the recording itself, in place of its curve,";
}

double root_mean_square(const std::vector<GapDomain>& domains, double GapDomain::*gap) {
    double sum = 0.0;
    for (const GapDomain& domain : domains) { sum += domain.*gap * domain.*gap; }
    return domains.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(domains.size()));
}

Json residual_json(const CurveResidual& residual) {
    return {
        {"rms_dB", residual.rms_db}, {"worst_dB", residual.worst_db}, {"worst_tau_s", residual.worst_tau_s}};
}

Json coefficients_json(const DiagnosedCurve& curve, const RateUnit& unit) {
    Json json = Json::object();
    for (const CurveCause& cause : curve.diagnosis.causes) {
        const CurveTerm::Kind kind = cause.term.kind;
        if (kind == CurveTerm::Kind::gauss_markov || kind == CurveTerm::Kind::sinusoid) { continue; }
        Json& one = json[std::string(name_of(kind))];
        one["model"] = cause.in_model ? cause.in_model->size * unit.per_column_unit : 0.0;
        one["curve"] = cause.term.size * unit.per_column_unit;
        if (cause.in_model) { one["factor"] = cause.factor(); }
        one["unit"] = noise_unit(static_cast<NoiseTerm>(kind), unit);
    }
    return json;
}

Json curve_json(const DiagnosedCurve& curve, const RateUnit& unit) {
    const CurveDiagnosis& diagnosis = curve.diagnosis;
    Json json;
    json["axis"] = axis_names.at(curve.axis);
    json["points"] = diagnosis.points;
    json["floor_dB"] = diagnosis.floor_db;
    json["before"] = residual_json(diagnosis.before);
    json["after"] = residual_json(diagnosis.after);
    json["stretches"] = Json::array();
    for (const CurveGapStretch& stretch : diagnosis.stretches) {
        json["stretches"].push_back({{"from_tau_s", stretch.from_tau_s},
                                     {"to_tau_s", stretch.to_tau_s},
                                     {"worst_dB", stretch.worst_db},
                                     {"worst_tau_s", stretch.worst_tau_s}});
    }
    json["coefficients"] = coefficients_json(curve, unit);
    return json;
}

// Of all curves together, by the same rule as of one.
Verdict verdict_of(const CurveDiagnosisReport& report, const Diagnosis& whole) {
    using Of = CurveDiagnosis::Verdict;
    const auto all = [&](auto is) {
        return std::ranges::all_of(report.curves,
                                   [&](const DiagnosedCurve& curve) { return is(curve.diagnosis.verdict); });
    };
    if (all([](Of one) { return one == Of::none; })) { return Verdict::none; }
    const bool all_closed = all([](Of one) { return one == Of::none || one == Of::known; });
    if (all_closed || 1.0 - whole.shrink.value < curve_share_min) { return Verdict::known; }
    const bool is_named = std::ranges::any_of(whole.causes, [](const Cause& cause) {
        return cause.score >= curve_probability_min && cause.share.value >= curve_share_min;
    });
    return is_named ? Verdict::partly : Verdict::unexplained;
}

// Where measured and model part, on all curves.
Place place_of(const CurveDiagnosisReport& report) {
    Place place;
    for (const DiagnosedCurve& curve : report.curves) {
        if (curve.diagnosis.verdict == CurveDiagnosis::Verdict::none) { continue; }
        if (std::ranges::count(place.axes, curve.axis) == 0) { place.axes.push_back(curve.axis); }
        for (const CurveGapStretch& stretch : curve.diagnosis.stretches) {
            place.tau_s = joined(place.tau_s, stretch.from_tau_s, stretch.to_tau_s);
        }
    }
    return place;
}

std::vector<Left> left_of(const CurveDiagnosisReport& report) {
    std::vector<Left> left;
    for (const DiagnosedCurve& curve : report.curves) {
        for (const CurveLeft& one : curve.diagnosis.left) {
            left.push_back({{}, one.floors});
            left.back().where.axes = {curve.axis};
            left.back().where.tau_s = Span{one.from_tau_s, one.to_tau_s};
        }
    }
    std::ranges::stable_sort(left, std::ranges::greater(), &Left::size);
    return left;
}

}  // namespace

Diagnosis as_diagnosis(const CurveDiagnosisReport& report) {
    Diagnosis diagnosis;
    diagnosis.recording_name = report.curve_name;
    diagnosis.model_name = report.model_name;
    diagnosis.band_probability = probability_in_band;
    diagnosis.where = place_of(report);
    diagnosis.left = left_of(report);
    diagnosis.warnings = report.warnings;
    double excess = 0.0;
    for (const DiagnosedCurve& curve : report.curves) { excess += excess_of(curve); }
    for (const DiagnosedCurve& curve : report.curves) {
        diagnosis.axes.push_back(curve.axis);
        diagnosis.domains.push_back(domain_of(curve, report.options.reading_error));
        GapDomain& domain = diagnosis.domains.back();
        if (domain.after_lo.empty()) { domain.gap_after = domain.gap_before; }
        const double part = excess > 0.0 ? excess_of(curve) / excess : 0.0;
        for (const CurveCause& cause : curve.diagnosis.causes) { put_cause(diagnosis, curve, cause, part); }
    }
    std::ranges::stable_sort(diagnosis.causes, std::ranges::greater(),
                             [](const Cause& cause) { return cause.share.value; });
    diagnosis.gap_before.value = root_mean_square(diagnosis.domains, &GapDomain::gap_before);
    diagnosis.gap_after.value = root_mean_square(diagnosis.domains, &GapDomain::gap_after);
    diagnosis.gap_named = diagnosis.gap_after;  // nothing is modelled without a name
    const double before = diagnosis.gap_before.value * diagnosis.gap_before.value - 1.0;
    const double after = diagnosis.gap_after.value * diagnosis.gap_after.value - 1.0;
    if (!diagnosis.causes.empty() && before > 0.0) {
        diagnosis.shrink.value = diagnosis.shrink_modelled = std::min(1.0, 1.0 - after / before);
    }
    diagnosis.verdict = verdict_of(report, diagnosis);
    return diagnosis;
}

std::string curve_diagnosis_json(const CurveDiagnosisReport& report) {
    Json json = diagnosis_object(as_diagnosis(report));
    for (const char* of_recordings :
         {"p_none", "p_left", "shrink_lo", "shrink_hi", "held_out", "recording", "rate_hz", "duration_s",
          "samples", "simulations", "seed", "untestable"}) {
        json.erase(of_recordings);
    }
    for (const char* gap : {"gap_before", "gap_named", "gap_after"}) {
        json[gap].erase("lo");
        json[gap].erase("hi");
    }
    for (Json& cause : json["causes"]) {
        for (const char* of_recordings : {"sentence", "share_lo", "share_hi"}) { cause.erase(of_recordings); }
    }
    // Print gives no second data.
    json["not_held_out"] = Json::array();
    for (const Json& cause : json["causes"]) { json["not_held_out"].push_back(cause["effect"]); }
    json["curve"] = {{"name", report.curve_name}, {"reading_error", report.options.reading_error}};
    json["curves"] = Json::object();
    for (const DiagnosedCurve& curve : report.curves) {
        json["curves"][curve.name] = curve_json(curve, report.unit);
    }
    return json_text(json);
}

}  // namespace gyrolog
