// Which denoiser a user asks for.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "analysis/denoise/array_denoiser.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// As the options say it.
struct DenoiseChoice {
    std::string method = "joint";
    std::string rate_model;  // empty: the method's own
    std::optional<double> bandwidth_hz;
    std::string gain = "varying";
    std::size_t window = 256;
    bool watch_off = false;
};

// For samples of this rate. Error invalid_argument where the choice contradicts itself or the rate.
Result<DenoiseDesign> design_of(const DenoiseChoice& choice, double rate_hz);

}  // namespace gyrolog
