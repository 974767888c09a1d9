// The sections of the page, from top to bottom.
#pragma once

#include <string>
#include <vector>

#include "host/report/html.hpp"
#include "host/report/report_page.hpp"

namespace gyrolog {

// One sensor of the page.
struct SensorPart {
    const ReportPage& page;
    const SensorFigures& figures;
    const std::vector<AxisReport>& axes;
    SensorUnit unit;  // of a gyro or of an accelerometer
    std::string of;   // " of the accelerometer", behind a title; empty where the page is of a gyro alone

    bool is_gyro() const { return unit.sensor == SensorKind::gyro; }
};

Html recording_section(const ReportPage& page);
// For each sensor:
Html figures_section(const SensorPart& part);
Html coefficients_section(const SensorPart& part);
// Of an accelerometer the mean with gravity in it, and what that tells of gravity and tilt.
Html bias_section(const SensorPart& part);
// Nothing without a diagnosis.
Html diagnosis_section(const ReportPage& page);
Html next_section(const ReportPage& page);

}  // namespace gyrolog
