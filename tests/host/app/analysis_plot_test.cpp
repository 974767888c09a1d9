#include "host/app/analysis_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gyrolog {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

AnalysisReport report_on(const std::vector<std::string>& axes) {
    AnalysisReport report;
    report.rate_hz = 100.0;
    for (const std::string& axis : axes) {
        report.axes.emplace_back();
        report.axes.back().axis = axis;
        report.axes.back().temperature = TemperatureDrift{};
    }
    return report;
}

TEST(AnalysisFigure, SaysWhichAxesLackTheirDriftWithTemperature) {
    AnalysisReport report = report_on({"x", "y", "z"});
    EXPECT_THAT(analysis_figure(report, SensorKind::gyro).facts, Not(Contains(HasSubstr("temperature"))));
    report.axes[0].temperature->is_taken_off = true;
    report.axes[2].temperature->is_taken_off = true;
    EXPECT_THAT(analysis_figure(report, SensorKind::gyro).facts,
                Contains("without the drift with temperature of x, z"));
}

TEST(AnalysisFigure, SaysThatTheSensorMoved) {
    AnalysisReport report = report_on({"x", "y"});
    report.accelerometer.emplace().axes.resize(1);
    for (AxisReport& axis : report.axes) { axis.fit.method = FitMethod::likelihood; }
    report.axes[1].fit.model_error = 0.4;
    EXPECT_THAT(analysis_figure(report, SensorKind::gyro).facts, Not(Contains(HasSubstr("moved"))));
    report.axes[1].fit.model_error = 0.6;
    for (const SensorKind sensor : {SensorKind::gyro, SensorKind::accelerometer}) {
        EXPECT_THAT(analysis_figure(report, sensor).facts,
                    Contains("the sensor moved: no noise coefficients"));
    }
}

}  // namespace
}  // namespace gyrolog
