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

void put_in_g(Finding& finding) {
    put_in_g(finding.entries);
    for (auto& sd : finding.sd) {
        EffectModel as_params;
        as_params.params = std::move(sd);
        sd = as_accelerometer_effect(as_params, scale).params;
    }
}

void put_in_g(GapDomain& domain) {
    constexpr std::string_view in_dps = "(deg/s)";
    const std::size_t unit = domain.y_name.find(in_dps);
    if (unit == std::string::npos) { return; }
    domain.y_name.replace(unit, in_dps.size(), "(g)");
    for (std::vector<double>* values :
         {&domain.recording, &domain.before_lo, &domain.before_hi, &domain.after_lo, &domain.after_hi}) {
        for (double& value : *values) { value /= dps_per_g(scale); }
    }
}

bool is_of_motion(const Untestable& one) {
    const EffectDefinition* effect = find_effect(one.effect);
    return effect != nullptr && effect->signature != nullptr &&
           (effect->signature->needs_reference || effect->signature->needs_specific_force);
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

Diagnosis diagnosis_of_accelerometer(Diagnosis as_gyro, const SensorModel& model) {
    Diagnosis diagnosis = std::move(as_gyro);
    diagnosis.unit = unit_of_accelerometer_as_gyro();
    for (Cause& cause : diagnosis.causes) { put_in_g(cause.finding); }
    for (Unnamed& form : diagnosis.unnamed) { put_in_g(form.entries); }
    for (GapDomain& domain : diagnosis.domains) { put_in_g(domain); }
    std::erase_if(diagnosis.untestable, is_of_motion);
    diagnosis.corrected = with_accelerometer_of(model, diagnosis.corrected);
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
