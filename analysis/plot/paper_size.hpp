// How large a figure is on paper, and how finely its pixels lie. A figure's lengths are in pixels of scale 1,
// in which the smallest letters are `letter_px`: at any resolution these come out as letters of `letter_pt`
// on paper.
#pragma once

namespace gyrolog {

inline constexpr double letter_px = 19.0;        // at scale 1
inline constexpr double letter_pt = 8.0;         // what journals take as the least
inline constexpr double least_panel_px = 360.0;  // at scale 1, of a column
inline constexpr double text_height_mm = 250.0;  // of a page of A4
inline constexpr double sheet_height_mm = 297.0;
inline constexpr double points_per_inch = 72.0;
inline constexpr double mm_per_inch = 25.4;
inline constexpr double dpi_of_scale_1 = letter_px / letter_pt * points_per_inch;

struct PaperSize {
    double width_mm = 180.0;  // of the text on A4, of two columns in a journal
    double dpi = 300.0;       // pixels in an inch

    double scale() const { return dpi / dpi_of_scale_1; }
    double width_at_scale_1_px() const { return width_mm / mm_per_inch * dpi_of_scale_1; }
    // That are wide enough for a panel each.
    int columns_up_to(int most) const;
    int width_px() const { return pixels(width_mm); }
    int pixels(double length_mm) const;             // to the nearest
    int scaled_pixels(double at_scale_1_px) const;  // to the nearest
};

}  // namespace gyrolog
