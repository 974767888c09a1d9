// gyrolog-denoise/1: what denoising achieved. Rates in the report's unit (variances in its square), "unit".
#pragma once

#include "host/formats/denoise_text.hpp"
#include "host/formats/json_fwd.hpp"

namespace gyrolog {

Json denoise_json(const DenoiseReport& report);

}  // namespace gyrolog
