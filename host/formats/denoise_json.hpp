// gyrolog-denoise/1: what denoising achieved. Rates in the report's unit (variances in its square), "unit".
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "host/formats/denoise_text.hpp"

namespace gyrolog {

nlohmann::ordered_json denoise_json(const DenoiseReport& report);

}  // namespace gyrolog
