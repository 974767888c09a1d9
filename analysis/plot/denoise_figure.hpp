// What denoising did, axis by axis: the signal at rest before and after; its error in motion, where there is
// a reference, or else how it begins; the Allan deviation and the density of the noise; noise and lag against
// the bandwidth.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/denoise/denoise.hpp"
#include "analysis/plot/figure.hpp"
#include "analysis/plot/paper_size.hpp"

namespace gyrolog {

struct DenoiseFigure {
    const Recording& recording;
    std::span<const AxisDenoising> axes;
    TimeSpan still;
    std::vector<std::string> facts;
    std::string unit = "°/s";
    double per_column_unit = 1.0;
    std::string quantity = "rate";  // that the unit is of
    PaperSize paper{};
};

Figure figure_of(const DenoiseFigure& denoise);
Rendering render(const DenoiseFigure& denoise);

}  // namespace gyrolog
