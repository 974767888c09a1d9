// How far units of one kind lie apart: a panel for each parameter, in it the units of each axis side by side
// in the order of their values, each with its uncertainty, over the median and the spread between them.
//
// The units that do not stand out fill a quarter of a panel's height at least: what lies farther away is
// marked at the panel's edge, with its value.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/plot/figure.hpp"
#include "analysis/plot/paper_size.hpp"

namespace gyrolog {

struct PlottedUnit {
    std::string name;
    double value = 0.0;
    double uncertainty = 0.0;  // standard uncertainty
    bool stands_out = false;
};

struct PlottedSpread {
    double median = 0.0;
    double sd = 0.0;  // between units
};

struct AxisUnits {
    std::string axis;  // "x"
    std::vector<PlottedUnit> units;
    std::optional<PlottedSpread> spread;  // absent: of too few units
};

struct UnitParameter {
    std::string title;  // "bias (°/s)"
    std::vector<AxisUnits> axes;
};

struct UnitSpreadFigure {
    std::vector<UnitParameter> parameters;
    PaperSize paper{};
};

Figure figure_of(const UnitSpreadFigure& spread);

Rendering render(const UnitSpreadFigure& spread);

}  // namespace gyrolog
