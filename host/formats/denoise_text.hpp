// What denoising achieved, for people.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/denoise/denoise.hpp"

namespace gyrolog {

struct DenoiseReport {
    std::string name;  // of the recordings
    double rate_hz = 0.0;
    double duration_s = 0.0;
    std::size_t samples = 0;
    std::string unit = "dps";  // in which rates are shown
    double per_column_unit = 1.0;
    TimeSpan still;            // in the recording
    std::string learned_from;  // where the units' noise comes from
    std::vector<std::string> warnings;
    std::vector<AxisDenoising> axes;
};

std::string denoise_text(const DenoiseReport& report);

// "joint: trend of 4 Hz, then wavelet"
std::string design_text(const DenoiseDesign& design);

}  // namespace gyrolog
