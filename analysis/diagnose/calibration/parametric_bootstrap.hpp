// The parametric bootstrap tells how well the parameters of what was found are known (B. Efron, R. J.
// Tibshirani, An Introduction to the Bootstrap, 1993, 6.5).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

struct BootstrapOptions {
    std::uint64_t seed = 1;
    unsigned threads = 0;
    std::function<bool(double)> on_progress{};  // with the share that is done; false ends the work
};

// The function takes some simulations of the sensor with all causes, 4 to 16 by the recording's length, for
// the recording, the reference's noise included, and looks for each cause again, the others in the model. A
// parameter's standard deviation becomes the root mean square of what comes back off what was put in, where
// that is more than the curvature of the likelihood has it. So parameters that give way to each other,
// estimates that are off, and noise that is no part of the likelihood are all in it. What no simulation shows
// again keeps its own.
//
// `without` is the prediction of the model without the causes, `corrected` the model with them. The function
// returns no value when ended early.
std::optional<std::vector<Finding>> with_bootstrap_sd(const std::shared_ptr<const Prediction>& without,
                                                      const SensorModel& corrected,
                                                      std::vector<Finding> causes,
                                                      const BootstrapOptions& options);

}  // namespace gyrolog
