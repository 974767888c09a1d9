// What is wrong with a figure's letters on paper: too small, cut short, over each other or over the edge.
#pragma once

#include <string>
#include <vector>

#include "analysis/plot/drawing.hpp"
#include "analysis/plot/paper_size.hpp"

namespace gyrolog {

struct Lettering {
    std::string text;
    Box ink;
    double size_pt;
};

inline std::vector<Lettering> letterings_of(const Drawing& drawing) {
    std::vector<Lettering> letterings;
    for (const auto& mark : drawing.marks) {
        const auto* drawn = std::get_if<DrawnText>(&mark);
        if (drawn == nullptr || drawn->text.empty()) { continue; }
        const TextExtent extent = drawn->typeface.measure(drawn->text, drawn->size_px);
        const Point pen = drawn->pen;
        const Box ink =
            drawn->upwards
                ? Box{pen.x - extent.ascent_px, pen.y - extent.width_px, pen.x + extent.descent_px, pen.y}
                : Box{pen.x, pen.y - extent.ascent_px, pen.x + extent.width_px, pen.y + extent.descent_px};
        letterings.push_back({drawn->text, ink, drawn->size_px / drawing.dpi * points_per_inch});
    }
    return letterings;
}

inline std::vector<std::string> faults_of_letters(const Drawing& drawing, double least_pt = letter_pt) {
    std::vector<std::string> faults;
    const std::vector<Lettering> letterings = letterings_of(drawing);
    const Box sheet{0.0, 0.0, double(drawing.width_px), double(drawing.height_px)};
    for (std::size_t i = 0; i < letterings.size(); ++i) {
        const Lettering& one = letterings[i];
        if (one.size_pt < least_pt - 1e-6) { faults.push_back("small: " + one.text); }
        if (one.text.find("…") != std::string::npos) { faults.push_back("cut: " + one.text); }
        if (!sheet.contains(one.ink)) { faults.push_back("over the edge: " + one.text); }
        for (std::size_t k = 0; k < i; ++k) {
            if (one.ink.overlaps(letterings[k].ink)) {
                faults.push_back("'" + one.text + "' over '" + letterings[k].text + "'");
            }
        }
    }
    return faults;
}

}  // namespace gyrolog
