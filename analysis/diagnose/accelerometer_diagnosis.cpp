#include "analysis/diagnose/accelerometer_diagnosis.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "analysis/simulate/accelerometer_as_gyro.hpp"
#include "analysis/simulate/accelerometer_effect.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {
namespace {

constexpr double scale = accelerometer_rad_s_per_m_s2;

void put_in_g(std::vector<EffectModel>& entries) {
    for (EffectModel& entry : entries) { entry = as_accelerometer_effect(entry, scale); }
}

void put_in_g(Place& where) {
    if (!where.rate_rad_s) { return; }
    where.force_m_s2 = Span{where.rate_rad_s->from / scale, where.rate_rad_s->to / scale};
    where.rate_rad_s.reset();
}

void put_in_g(Finding& finding) {
    finding.sensor = SensorKind::accelerometer;
    put_in_g(finding.where);
    put_in_g(finding.entries);
    for (auto& sd : finding.sd) {
        EffectModel as_params;
        as_params.params = std::move(sd);
        sd = as_accelerometer_effect(as_params, scale).params;
    }
}

bool replaced(std::string& text, std::string_view what, std::string_view by) {
    const std::size_t at = text.find(what);
    if (at == std::string::npos || what.empty()) { return false; }
    text.replace(at, what.size(), by);
    return true;
}

void put_in_g(std::vector<double>& values) {
    for (double& value : values) { value /= dps_per_g(scale); }
}

void put_in_g(GapDomain& domain) {
    constexpr std::string_view in_dps = "(deg/s)";
    constexpr std::string_view in_g = "(g)";
    replaced(domain.name, "rate about", "force along");
    replaced(domain.name, "by rate", "by force");
    replaced(domain.x_name, "reference rate", "known force");
    if (replaced(domain.x_name, in_dps, in_g)) { put_in_g(domain.x); }
    if (!replaced(domain.y_name, in_dps, in_g)) { return; }
    for (std::vector<double>* values :
         {&domain.recording, &domain.before_lo, &domain.before_hi, &domain.after_lo, &domain.after_hi}) {
        put_in_g(*values);
    }
}

// The recordings that would tell effects apart, in words of forces.
void put_in_words_of_force(std::string& text) {
    for (const ChainLink& link : signal_chain()) {
        const EffectSignature* signature = link.effect == nullptr ? nullptr : link.effect->signature;
        if (signature == nullptr || signature->force_decided_by.empty()) { continue; }
        if (replaced(text, signature->decided_by, signature->force_decided_by)) { return; }
    }
}

bool is_of_gyros_only(const Untestable& one, Exposure exposure) {
    const EffectDefinition* effect = find_effect(one.effect);
    return effect != nullptr && effect->signature != nullptr &&
           (effect->signature->needs_specific_force ||
            (effect->signature->needs_reference && exposure == Exposure::upright));
}

bool overlap(const std::optional<Span>& one, const std::optional<Span>& other) {
    return one && other && one->from <= other->to && other->from <= one->to;
}

// The same effect by itself is none: two sensors have two noises. A place is, which nothing but what they
// share would give to both.
bool is_shared(const Finding& of_gyro, const Finding& of_accelerometer) {
    const EffectDefinition* effect = find_effect(of_gyro.effect);
    if (of_gyro.effect != of_accelerometer.effect || effect == nullptr || effect->signature == nullptr) {
        return false;
    }
    switch (effect->signature->place) {
        case PlaceKind::structure:
            return true;
        case PlaceKind::instant:
            return overlap(of_gyro.where.time_s, of_accelerometer.where.time_s);
        default:
            break;
    }
    const EvidenceMethod method = effect->signature->method;
    return (method == EvidenceMethod::line || method == EvidenceMethod::narrow_band) &&
           overlap(of_gyro.where.freq_hz, of_accelerometer.where.freq_hz);
}

}  // namespace

Diagnosis diagnosis_of_accelerometer(Diagnosis as_gyro, const SensorModel& model, Exposure exposure) {
    Diagnosis diagnosis = std::move(as_gyro);
    diagnosis.unit = unit_of_accelerometer_as_gyro();
    put_in_g(diagnosis.where);
    for (Cause& cause : diagnosis.causes) {
        put_in_g(cause.finding);
        put_in_words_of_force(cause.decided_by);
    }
    for (std::string& proposal : diagnosis.next_recordings) { put_in_words_of_force(proposal); }
    for (Unnamed& form : diagnosis.unnamed) {
        put_in_g(form.where);
        put_in_g(form.entries);
    }
    for (Left& left : diagnosis.left) { put_in_g(left.where); }
    for (GapDomain& domain : diagnosis.domains) { put_in_g(domain); }
    std::erase_if(diagnosis.untestable,
                  [&](const Untestable& one) { return is_of_gyros_only(one, exposure); });
    diagnosis.corrected = with_accelerometer_of(model, diagnosis.corrected, exposure);
    return diagnosis;
}

std::vector<std::string> shared_causes(const Diagnosis& gyro, const Diagnosis& accelerometer) {
    std::vector<std::string> shared;
    for (const Cause& cause : gyro.causes) {
        const auto has_it = [&](const Cause& other) { return is_shared(cause.finding, other.finding); };
        if (std::ranges::any_of(accelerometer.causes, has_it) &&
            std::ranges::count(shared, cause.finding.effect) == 0) {
            shared.push_back(cause.finding.effect);
        }
    }
    return shared;
}

}  // namespace gyrolog
