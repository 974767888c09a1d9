// The whole analysis of curves from print: a model for each, and the gap of each simulation to its sensor.
#pragma once

#include <string>
#include <vector>

#include "analysis/noise/analyze.hpp"
#include "analysis/noise/curve_gap.hpp"
#include "analysis/noise/curve_model.hpp"
#include "analysis/noise/slope_reading.hpp"

namespace gyrolog {

struct PrintedCurve {
    std::string name;  // "x", "sensor_x"
    AllanCurve curve;  // rad/s or m/s^2, by rising tau; without m, degrees of freedom and terms
};

// Curves that were read from one table.
struct PrintedCurves {
    std::string name;  // of the file
    SensorUnit unit;   // in which to show them
    std::vector<PrintedCurve> curves;
    std::vector<std::string> warnings;
};

struct PrintedCurveReport {
    std::string name;
    AllanCurve curve;
    CurveModelFit fit;
    SlopeReading slopes;
};

struct NamedCurveGap {
    std::string sensor;      // name of the curve
    std::string simulation;  // likewise
    CurveGap gap;
};

struct CurveReport {
    std::string name;
    SensorUnit unit;
    CurveFitOptions options;
    std::vector<PrintedCurveReport> curves;
    std::vector<NamedCurveGap> gaps;
    std::vector<std::string> warnings;
};

// "sensor_x" and "simulation_x" are compared, and so are all that agree but for this prefix; `measured`,
// `real` and `simulated`, `sim` mean the same.
CurveReport analyze_curves(PrintedCurves curves, const CurveFitOptions& options = {});

}  // namespace gyrolog
