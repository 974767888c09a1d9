// A better shape takes the place of causes that it beats by far: something is there that resembles them and
// is no effect of the catalogue.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/report.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"

namespace gyrolog {

struct ShapeOptions {
    // A shape wins by this much evidence,
    double wins_nats = decisions.certain_nats();
    // and by this share of the causes' gain: the approximations of a fit may lose as much.
    double wins_share = 0.04;
    std::uint64_t seed = 1;
    unsigned threads = 0;
};

// The function tries shapes in place of every cause, and of all that the spectra tell, and returns the one
// that wins by most. `given` is the prediction of the model as it was given.
std::optional<BetterShape> better_shape(const CauseSelection& selection,
                                        const std::shared_ptr<const Prediction>& given,
                                        const std::shared_ptr<const Recording>& recording,
                                        const ShapeOptions& options);

}  // namespace gyrolog
