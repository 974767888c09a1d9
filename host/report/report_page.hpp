// A recording on one page: what it is and how whole, of each sensor its noise and its bias, where a model
// parts from it, and what to record next. The page is one file of HTML with its pictures inside: nothing is
// fetched, nothing runs. It reads in light and in dark, prints on A4, and loses nothing in grey.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "analysis/noise/analyze.hpp"
#include "analysis/recording/recording.hpp"
#include "host/formats/labelled_line.hpp"

namespace gyrolog {

struct TemperatureRange {
    double lowest_degC = 0.0;
    double highest_degC = 0.0;
};

using Png = std::vector<std::uint8_t>;

// Empty where there is none.
struct SensorFigures {
    Png deviation_png{};
    Png spectrum_png{};
    std::vector<Png> samples_pngs{};  // one after the other
    std::vector<Png> course_pngs{};
};

struct ReportPage {
    const AnalysisReport& analysis;
    std::vector<LabelledLine> about;  // what a capture says of itself; of text nothing
    std::vector<Dropout> dropouts;    // without the stops
    std::optional<TemperatureRange> temperature;
    const Diagnosis* diagnosis = nullptr;  // null: no model was given
    SensorFigures gyro{};
    SensorFigures accelerometer{};
    Png diagnosis_png{};  // empty where there is none
};

std::string report_html(const ReportPage& page);

}  // namespace gyrolog
