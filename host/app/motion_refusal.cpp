#include "host/app/motion_refusal.hpp"

#include <fmt/format.h>

namespace gyrolog {
namespace {

std::string axes_of_motion(const std::vector<AxisReport>& axes) {
    std::string names;
    for (const AxisReport& axis : axes) {
        if (axis.fit.is_of_motion()) { names += ' ' + axis.axis; }
    }
    return names;
}

}  // namespace

Status refuse_motion(const AnalysisReport& report, const std::string& path, const std::string& result) {
    if (!report.is_of_motion()) { return {}; }
    std::string where;
    if (const std::string names = axes_of_motion(report.axes); !names.empty()) { where = "gyro" + names; }
    if (report.accelerometer) {
        const std::string names = axes_of_motion(report.accelerometer->axes);
        if (!names.empty()) { where += (where.empty() ? "accelerometer" : ", accelerometer") + names; }
    }
    return Error{ErrorCode::failed,
                 fmt::format("'{}': no {} from a recording in motion or under vibration ({}): its "
                             "coefficients are not the sensor's noise; --still auto takes the longest part "
                             "at rest, --from and --to a part that is named",
                             path, result, where)};
}

}  // namespace gyrolog
