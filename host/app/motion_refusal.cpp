#include "host/app/motion_refusal.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/recording/still_runs.hpp"
#include "host/app/denoise_knowledge.hpp"

namespace gyrolog {
namespace {

std::string axes_of_motion(const std::vector<AxisReport>& axes) {
    std::string names;
    for (const AxisReport& axis : axes) {
        if (axis.fit.is_of_motion()) { names += ' ' + axis.axis; }
    }
    return names;
}

// Of the rows, as far as the gyro tells.
double share_in_motion(const Recording& recording) {
    std::size_t at_rest = 0;
    for (const Segment& run : still_runs(recording, gyro_means(recording))) { at_rest += run.count; }
    return 1.0 -
           static_cast<double>(at_rest) / static_cast<double>(std::max<std::size_t>(1, recording.rows()));
}

}  // namespace

Status refuse_motion(const AnalysisReport& report, const Recording& recording, const std::string& path,
                     const std::string& result, const MotionRefusalOptions& options) {
    if (!report.is_of_motion() || share_in_motion(recording) <= options.touched_most) { return {}; }
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
