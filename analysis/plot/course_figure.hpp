// How the bias goes: means of the rate over parts of the record, in time, and where the temperature is known
// the temperature below it and the same means over the temperature.
#pragma once

#include <string>
#include <vector>

#include "analysis/plot/figure.hpp"
#include "analysis/plot/paper_size.hpp"

namespace gyrolog {

struct CourseTrace {
    std::string name;           // "x"
    std::vector<double> means;  // of equal parts of the record, about the bias; NaN where nothing is known
};

struct CourseFigure {
    std::string title = "Course of the bias";
    std::string source;
    std::vector<std::string> facts;
    std::string signal_name = "rate";
    std::string mean_name = "bias";
    std::string unit_name = "°/s";
    double per_unit_of_data = 1.0;
    double duration_s = 0.0;
    std::vector<CourseTrace> traces;
    std::vector<double> temperature_degC;  // of the same parts; empty: not known
    PaperSize paper{};
};

Figure figure_of(const CourseFigure& course);

Rendering render(const CourseFigure& course);

}  // namespace gyrolog
