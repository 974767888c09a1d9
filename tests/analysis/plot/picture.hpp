// A rendered PNG, decoded again to look at its pixels; and a size for one that is soon drawn.
#pragma once

#include <algorithm>
#include <cstdlib>

#include <opencv2/imgcodecs.hpp>

#include "analysis/plot/figure.hpp"
#include "analysis/plot/paper_size.hpp"

namespace gyrolog {

// 800 pixels, of scale 0.5.
inline constexpr PaperSize small_paper{237.67, 85.5};

class Picture {
public:
    explicit Picture(const Rendering& rendering) : pixels_(cv::imdecode(rendering.png, cv::IMREAD_COLOR)) {}

    int width_px() const { return pixels_.cols; }
    int height_px() const { return pixels_.rows; }

    // Whether that colour (give or take antialiasing) is within a pixel of the point.
    bool has(Colour colour, Point at, int tolerance = 40) const {
        const int x = static_cast<int>(at.x);
        const int y = static_cast<int>(at.y);
        for (int row = std::max(0, y - 1); row <= std::min(y + 1, pixels_.rows - 1); ++row) {
            for (int column = std::max(0, x - 1); column <= std::min(x + 1, pixels_.cols - 1); ++column) {
                if (is_like(row, column, colour, tolerance)) { return true; }
            }
        }
        return false;
    }

    int count(Colour colour, int tolerance = 0) const {
        int found = 0;
        for (int row = 0; row < pixels_.rows; ++row) {
            for (int column = 0; column < pixels_.cols; ++column) {
                found += is_like(row, column, colour, tolerance);
            }
        }
        return found;
    }

private:
    bool is_like(int row, int column, Colour colour, int tolerance) const {
        const auto& pixel = pixels_.at<cv::Vec3b>(row, column);
        return std::abs(pixel[0] - colour.blue) <= tolerance &&
               std::abs(pixel[1] - colour.green) <= tolerance && std::abs(pixel[2] - colour.red) <= tolerance;
    }

    cv::Mat pixels_;
};

}  // namespace gyrolog
