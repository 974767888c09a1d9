#include "host/app/motion_refusal.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "analysis/recording/still_runs.hpp"
#include "analysis/simulate/accelerometer_as_gyro.hpp"
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

std::vector<double> means_of_runs(const Recording& recording, const Column& column, std::size_t rows) {
    std::vector<double> means;
    for (const Segment& segment : recording.segments) {
        for (std::size_t from = 0; from + rows <= segment.count; from += rows) {
            double sum = 0.0;
            for (std::size_t row = from; row < from + rows; ++row) {
                sum += column.value(segment.first + row);
            }
            means.push_back(sum / static_cast<double>(rows));
        }
    }
    return means;
}

// Of the means, those that are farther from the median than `most` on any axis.
double share_beyond(const std::vector<std::vector<double>>& axes, double most) {
    std::vector<bool> is_beyond(axes.front().size(), false);
    for (const std::vector<double>& means : axes) {
        std::vector<double> sorted = means;
        const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
        std::ranges::nth_element(sorted, middle);
        for (std::size_t i = 0; i < means.size(); ++i) {
            if (std::abs(means[i] - *middle) > most) { is_beyond[i] = true; }
        }
    }
    return static_cast<double>(std::ranges::count(is_beyond, true)) / static_cast<double>(is_beyond.size());
}

}  // namespace

Status refuse_moving_accelerometer(const Recording& as_gyro, const std::string& path,
                                   const MotionRefusalOptions& options) {
    const auto rows = static_cast<std::size_t>(std::max(1.0, std::round(options.mean_s * as_gyro.rate_hz)));
    std::vector<std::vector<double>> axes;
    for (const char* axis : axis_names) {
        const Column* column = as_gyro.find(std::string("g") + axis);
        if (column != nullptr) { axes.push_back(means_of_runs(as_gyro, *column, rows)); }
    }
    if (axes.empty() || axes.front().empty()) { return {}; }
    const double share =
        share_beyond(axes, options.rest_most_g / unit_of_accelerometer_as_gyro().per_column_unit);
    if (share <= options.touched_most) { return {}; }
    return Error{ErrorCode::failed,
                 fmt::format("'{}': an accelerometer is diagnosed at rest only, and for {:.0f} % of the "
                             "recording it is turned or moved by more than {:g} g; --still auto takes the "
                             "longest part at rest, --from and --to a part that is named",
                             path, 100.0 * share, options.rest_most_g)};
}

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
