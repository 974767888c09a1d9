#include "analysis/diagnose/means_model.hpp"

#include <cmath>
#include <vector>

#include "analysis/simulate/chain.hpp"

namespace gyrolog {

bool shows_in_means(const EffectSignature& signature) {
    switch (signature.method) {
        case EvidenceMethod::tails:
        case EvidenceMethod::outliers:
        case EvidenceMethod::repeats:
        case EvidenceMethod::code_grid:
        case EvidenceMethod::ceiling:
        case EvidenceMethod::stamp_gaps:
        case EvidenceMethod::stamp_rate:
        case EvidenceMethod::stamp_spread:
            return false;
        default:
            return !signature.folds;
    }
}

SensorModel model_of_means(SensorModel model, std::size_t samples) {
    if (samples < 2) { return model; }
    const auto number = static_cast<double>(samples);
    const double converter = model.lsb_rad_s * model.lsb_rad_s / (12.0 * model.rate_hz);
    for (AxisModel& axis : model.axes) {
        axis.noise.N_rad_per_sqrt_s = std::hypot(axis.noise.N_rad_per_sqrt_s, std::sqrt(converter));
    }
    model.lsb_rad_s = 0.0;
    model.rate_hz /= number;
    for (double* sd :
         {&model.ref_noise_rad_s, &model.acc_noise_m_s2, &model.temp_noise_C, &model.timestamp_jitter_s}) {
        *sd /= std::sqrt(number);
    }
    std::erase_if(model.effects, [](const EffectModel& entry) {
        const EffectSignature* signature = find_effect(entry.effect)->signature;
        return signature == nullptr || !shows_in_means(*signature);
    });
    return model;
}

}  // namespace gyrolog
