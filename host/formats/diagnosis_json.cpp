#include "host/formats/diagnosis_json.hpp"

#include <algorithm>
#include <cstddef>

#include "analysis/recording/standard_gravity.hpp"
#include "host/formats/effect_words.hpp"
#include "host/formats/json.hpp"
#include "host/formats/noise_json.hpp"

namespace gyrolog {
namespace {

Json found_axes_json(const std::vector<std::size_t>& axes) {
    Json json = Json::array();
    for (const std::size_t axis : axes) { json.push_back(axis_names.at(axis)); }
    return json;
}

void put_span(Json& json, const char* key, const std::optional<Span>& span, double per_unit = 1.0) {
    if (span) { json[key] = {span->from * per_unit, span->to * per_unit}; }
}

// Without the axes.
Json place_json(const Place& place) {
    Json json = Json::object();
    put_span(json, "freq_hz", place.freq_hz);
    put_span(json, "tau_s", place.tau_s);
    put_span(json, "time_s", place.time_s);
    if (place.temperature) { json["temperature"] = true; }
    if (place.acceleration) { json["acceleration"] = true; }
    put_span(json, "rate_dps", place.rate_rad_s, deg_per_rad);
    put_span(json, "force_g", place.force_m_s2, 1.0 / standard_gravity_m_s2);
    put_span(json, "amplitude_sigma", place.amplitude_sigma);
    if (!place.structure.empty()) { json["structure"] = place.structure; }
    return json;
}

Json gap_json(const Gap& gap) {
    return {{"value", gap.value}, {"floor", gap.floor}, {"lo", gap.lo}, {"hi", gap.hi}};
}

// An entry without axes acts on all that the finding names.
std::vector<std::string> axes_of_entry(const Finding& finding, const EffectModel& entry) {
    if (!entry.axes.empty()) { return entry.axes; }
    std::vector<std::string> axes;
    for (const std::size_t axis : finding.where.axes) { axes.emplace_back(axis_names.at(axis)); }
    return axes;
}

double gain_of_entry(const Finding& finding, const EffectModel& entry) {
    const auto axes = axes_of_entry(finding, entry);
    double most = 0.0;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        if (std::ranges::count(axes, axis_names[axis]) > 0) {
            most = std::max(most, finding.axis_gain_nats[axis]);
        }
    }
    return most;
}

void put_params(Json& json, const Finding& finding) {
    const auto sd_of = [&](std::size_t entry) {
        return Json(entry < finding.sd.size() ? finding.sd[entry] : std::map<std::string, double>());
    };
    const auto strongest = std::ranges::max_element(
        finding.entries, {}, [&](const EffectModel& entry) { return gain_of_entry(finding, entry); });
    json["params"] = Json::object();
    json["sd"] = Json::object();
    if (strongest == finding.entries.end()) { return; }
    json["params"] = strongest->params;
    json["sd"] = sd_of(static_cast<std::size_t>(strongest - finding.entries.begin()));
    if (finding.entries.size() == 1) { return; }
    for (std::size_t entry = 0; entry < finding.entries.size(); ++entry) {
        for (const std::string& axis : axes_of_entry(finding, finding.entries[entry])) {
            json["params_by_axis"][axis] = finding.entries[entry].params;
            json["sd_by_axis"][axis] = sd_of(entry);
        }
    }
}

Json tie_group_json(const Cause& cause) {
    Json group = Json::array({cause.finding.effect});
    for (const Rival& rival : cause.tie_group) {
        if (rival.effect != cause.finding.effect) { group.push_back(rival.effect); }
    }
    return group;
}

Json whole_place_json(const Place& place) {
    Json json = Json::object();
    if (!place.axes.empty()) { json["axes"] = found_axes_json(place.axes); }
    json.update(place_json(place));
    return json;
}

void put_share(Json& json, const std::string& key, const Share& share) {
    json[key] = share.value;
    json[key + "_lo"] = share.lo;
    json[key + "_hi"] = share.hi;
}

Json cause_json(const Cause& cause) {
    const Finding& finding = cause.finding;
    Json json;
    json["effect"] = finding.effect;
    json["sense"] = name_of(cause.sense);
    json["score"] = cause.score;
    json["tie_group"] = tie_group_json(cause);
    json["axes"] = found_axes_json(finding.where.axes);
    json["where"] = place_json(finding.where);
    put_params(json, finding);
    put_share(json, "share", cause.share);
    json["sentence"] = cause_words(cause);
    json["gain_nats"] = finding.gain_nats;
    json["evidence_nats"] = finding.evidence_nats;
    for (const Rival& rival : cause.tie_group) {
        if (rival.effect != finding.effect) { json["tie"][rival.effect] = rival.evidence_below_best_nats; }
    }
    if (!cause.decided_by.empty()) { json["decided_by"] = cause.decided_by; }
    return json;
}

Json unnamed_json(const Unnamed& unnamed) {
    return {{"form", unnamed.form},
            {"axes", found_axes_json(unnamed.where.axes)},
            {"where", place_json(unnamed.where)},
            {"share", unnamed.share}};
}

Json left_json(const Left& left) { return {{"where", whole_place_json(left.where)}, {"size", left.size}}; }

Json answer_json(const Asked::Answer& answer) {
    Json json = {{"called_for", answer.is_called_for},
                 {"gain_nats", answer.gain_nats},
                 {"as_described_nats", answer.described_nats},
                 {"p", answer.p}};
    if (answer.amount) {
        json["amount"] = answer.amount->value;
        json["amount_sd"] = answer.amount->sd;
    }
    return json;
}

Json asked_json(const Asked& asked) {
    const EffectModel& entry = asked.described.entry;
    return {{"name", asked.described.name},
            {"effect", entry.effect},
            {"axes", entry.axes},
            {"beside_causes", answer_json(asked.beside)},
            {"alone", answer_json(asked.alone)}};
}

Json domain_json(const GapDomain& domain) {
    Json json;
    json["name"] = domain.name;
    json["axis"] = domain.axis_text();
    json["points"] = domain.x.size();
    json["outside_before"] = std::ranges::count(domain.outside_before, true);
    json["gap_before"] = domain.gap_before;
    if (!domain.after_lo.empty()) {
        json["outside_after"] = std::ranges::count(domain.outside_after, true);
        json["gap_after"] = domain.gap_after;
    }
    return json;
}

// In the model file's units.
Json noise_refits_json(const Diagnosis& diagnosis) {
    Json json = Json::array();
    const double per_unit = diagnosis.unit.per_column_unit;
    for (const NoiseRefit& one : diagnosis.noise_refits) {
        json.push_back({{"axis", axis_names.at(one.axis)},
                        {"coefficient", std::string(1, one.coefficient)},
                        {"stated", one.stated * per_unit},
                        {"fitted", one.fitted * per_unit},
                        {"sd", one.fitted_sd * per_unit}});
    }
    return json;
}

Json reference_json(const Diagnosis& diagnosis) {
    const ReferenceQuality& reference = *diagnosis.reference;
    const char* rates = reference.gyros > 0 ? "units" : "rates";
    Json json{{"of", reference.is_orientation ? "orientation" : rates},
              {"samples_per_row", reference.samples_per_row}};
    for (const std::size_t axis : diagnosis.axes) {
        const Span& error_rad_s = reference.error_rad_s.at(axis);
        json["error_dps"][axis_names.at(axis)] = {error_rad_s.from * deg_per_rad,
                                                  error_rad_s.to * deg_per_rad};
    }
    if (reference.gyros > 0) { json["gyros"] = reference.gyros; }
    json["latency_s"] = reference.latency_s;
    json["latency_sd_s"] = reference.latency_sd_s;
    json["bandwidth_hz"] = reference.bandwidth_hz;
    return json;
}

void put_circumstances(Json& json, const Diagnosis& diagnosis) {
    json["recording"] = diagnosis.recording_name;
    json["model"] = diagnosis.model_name;
    json["rate_hz"] = diagnosis.rate_hz;
    json["duration_s"] = diagnosis.duration_s;
    json["samples"] = diagnosis.samples;
    json["axes"] = found_axes_json(diagnosis.axes);
    for (const Pass& pass : diagnosis.passes) {
        json["looks"].push_back({{"duration_s", pass.duration_s},
                                 {"rows", pass.rows},
                                 {"samples_per_row", pass.samples_per_row},
                                 {"verdict", name_of(pass.verdict)},
                                 {"p_none", pass.p_none}});
        if (pass.is_at_rest) { json["looks"].back()["at_rest"] = true; }
    }
    if (diagnosis.reference) { json["reference"] = reference_json(diagnosis); }
    json["simulations"] = diagnosis.simulations;
    json["band_probability"] = diagnosis.band_probability;
    json["seed"] = diagnosis.seed;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::none:
            return "none";
        case Verdict::known:
            return "known";
        case Verdict::partly:
            return "partly";
        case Verdict::unexplained:
            return "unexplained";
    }
    return "";
}

std::string_view name_of(Sense sense) {
    return sense == Sense::recording_has ? "recording_has" : "model_has";
}

std::string diagnosis_json(const Diagnosis& diagnosis) { return json_text(diagnosis_object(diagnosis)); }

std::string diagnosis_json(const Diagnosis& gyro, const Diagnosis& accelerometer,
                           const std::vector<std::string>& shared) {
    Json json = diagnosis_object(gyro);
    json["accelerometer"] = diagnosis_object(accelerometer);
    json["shared"] = shared;
    return json_text(json);
}

Json diagnosis_object(const Diagnosis& diagnosis) {
    Json json;
    json["schema"] = "gyrolog-diagnosis/2";
    if (diagnosis.unit.sensor == SensorKind::accelerometer) { json["sensor"] = "accelerometer"; }
    json["verdict"] = name_of(diagnosis.verdict);
    json["p_none"] = diagnosis.p_none;
    json["p_left"] = diagnosis.p_left;
    json["causes"] = Json::array();
    for (const Cause& cause : diagnosis.causes) { json["causes"].push_back(cause_json(cause)); }
    if (!diagnosis.noise_refits.empty()) { json["noise_refitted"] = noise_refits_json(diagnosis); }
    if (diagnosis.better_shape) {
        json["better_shape"] = {{"words", diagnosis.better_shape->words},
                                {"than", diagnosis.better_shape->than},
                                {"evidence_nats", diagnosis.better_shape->evidence_nats}};
    }
    json["unnamed"] = Json::array();
    for (const Unnamed& one : diagnosis.unnamed) { json["unnamed"].push_back(unnamed_json(one)); }
    json["left"] = Json::array();
    for (const Left& one : diagnosis.left) { json["left"].push_back(left_json(one)); }
    json["where"] = whole_place_json(diagnosis.where);
    json["gap_before"] = gap_json(diagnosis.gap_before);
    json["gap_named"] = gap_json(diagnosis.gap_named);
    json["gap_after"] = gap_json(diagnosis.gap_after);
    put_share(json, "shrink", diagnosis.shrink);
    json["shrink_modelled"] = diagnosis.shrink_modelled;
    json["held_out"] = diagnosis.held_out;
    json["not_held_out"] = diagnosis.not_held_out;
    put_circumstances(json, diagnosis);
    json["domains"] = Json::array();
    for (const GapDomain& domain : diagnosis.domains) { json["domains"].push_back(domain_json(domain)); }
    json["untestable"] = Json::array();
    for (const Untestable& one : diagnosis.untestable) {
        json["untestable"].push_back({{"effect", one.effect}, {"why", one.why}});
    }
    for (const Asked& one : diagnosis.asked) { json["asked"].push_back(asked_json(one)); }
    json["next_recordings"] = diagnosis.next_recordings;
    json["warnings"] = diagnosis.warnings;
    return json;
}

}  // namespace gyrolog
