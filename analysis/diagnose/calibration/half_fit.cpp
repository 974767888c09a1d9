#include "analysis/diagnose/calibration/half_fit.hpp"

#include <string>
#include <utility>

#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/estimators/hypotheses.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

bool can_be_halved(const std::string& effect, const Prediction& prediction) {
    return !find_effect(effect)->signature->slow && traits_of(effect, prediction).can_be_halved;
}

std::vector<std::optional<Finding>> fitted_to_half(const std::shared_ptr<const Prediction>& half,
                                                   const std::shared_ptr<const Recording>& recording,
                                                   const std::vector<Finding>& causes, std::uint64_t seed) {
    std::vector<std::optional<Finding>> fits(causes.begin(), causes.end());
    const int rounds = causes.size() > 1 ? 2 : 1;
    const auto model_with_all_but = [&](std::size_t left_out) {
        SensorModel model = half->model();
        for (std::size_t i = 0; i < causes.size(); ++i) {
            if (i != left_out && fits[i]) { model = with_cause(std::move(model), *fits[i]); }
        }
        return model;
    };
    for (int round = 0; round < rounds; ++round) {
        const Observation completed(half->with(model_with_all_but(causes.size())), recording, seed);
        for (std::size_t i = 0; i < causes.size(); ++i) {
            if (!can_be_halved(causes[i].effect, *half)) { continue; }
            fits[i] = examine_for(causes[i].effect, half->with(model_with_all_but(i)), completed);
        }
    }
    return fits;
}

}  // namespace gyrolog
