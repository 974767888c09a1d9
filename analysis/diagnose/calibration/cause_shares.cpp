#include "analysis/diagnose/calibration/cause_shares.hpp"

#include <algorithm>

#include "analysis/simulate/chain.hpp"

namespace gyrolog {

bool is_event(const std::string& effect) {
    const EffectSignature* signature = find_effect(effect)->signature;
    return signature != nullptr && signature->event;
}

SensorModel without_events(SensorModel model, std::size_t first_entry) {
    const auto first = model.effects.begin() + static_cast<std::ptrdiff_t>(first_entry);
    model.effects.erase(std::remove_if(first, model.effects.end(),
                                       [](const EffectModel& entry) { return is_event(entry.effect); }),
                        model.effects.end());
    return model;
}

void share_among_causes(Diagnosis& diagnosis) {
    const auto part_nats = [&](const Cause& cause) {
        const bool has_part = diagnosis.held_out.empty() || !is_event(cause.finding.effect);
        return has_part ? std::max(cause.finding.gain_nats, 0.0) : 0.0;
    };
    double sum_nats = 0.0;
    for (const Cause& cause : diagnosis.causes) { sum_nats += part_nats(cause); }
    for (Cause& cause : diagnosis.causes) {
        cause.shrink_alone = sum_nats > 0.0 ? diagnosis.shrink * part_nats(cause) / sum_nats : 0.0;
    }
}

}  // namespace gyrolog
