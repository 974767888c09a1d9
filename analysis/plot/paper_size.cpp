#include "analysis/plot/paper_size.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {

int PaperSize::columns_up_to(int most) const {
    return std::clamp(static_cast<int>(width_at_scale_1_px() / least_panel_px), 1, most);
}

int PaperSize::pixels(double length_mm) const {
    return static_cast<int>(std::lround(length_mm / mm_per_inch * dpi));
}

int PaperSize::scaled_pixels(double at_scale_1_px) const {
    return static_cast<int>(std::lround(at_scale_1_px * scale()));
}

}  // namespace gyrolog
