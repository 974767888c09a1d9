#include "analysis/diagnose/selection/unnamed_forms.hpp"

#include <optional>
#include <utility>

#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

std::vector<Finding> unnamed_forms(std::shared_ptr<const Prediction> prediction,
                                   const std::shared_ptr<const Recording>& recording, std::uint64_t seed) {
    std::vector<Finding> found;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->form.empty()) { continue; }
        if (!untestable_in(*link.effect, *prediction).empty()) { continue; }
        const MadeEstimator made = make_estimator(*link.effect, prediction);
        if (!made.estimator) { continue; }
        std::optional<Finding> finding = made.estimator->find(Observation(prediction, recording, seed));
        if (!finding || finding->evidence_nats <= 0.0) { continue; }
        prediction = prediction->with(with_cause(prediction->model(), *finding));
        found.push_back(*std::move(finding));
    }
    return found;
}

Unnamed unnamed_of(const Finding& finding, const Share& share) {
    return {std::string(find_effect(finding.effect)->form), finding.where, share.value, finding.entries};
}

}  // namespace gyrolog
