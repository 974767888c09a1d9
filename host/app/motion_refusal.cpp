#include "host/app/motion_refusal.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/measures/unreferenced_motion.hpp"
#include "analysis/numerics/robust_spread.hpp"
#include "analysis/recording/block_means.hpp"
#include "analysis/recording/recording_part.hpp"
#include "analysis/recording/still_runs.hpp"
#include "analysis/simulate/accelerometer_as_gyro.hpp"
#include "host/app/denoise_knowledge.hpp"
#include "host/app/quantity.hpp"

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

// Of the blocks, those whose mean is farther from the median than `most` on any axis.
double share_beyond(const std::vector<std::vector<BlockMean>>& axes, double most) {
    std::set<std::int64_t> beyond;
    std::size_t blocks = 0;
    for (const std::vector<BlockMean>& of_axis : axes) {
        std::vector<double> means;
        std::ranges::transform(of_axis, std::back_inserter(means), &BlockMean::mean);
        const double median = median_of(means);
        for (const BlockMean& block : of_axis) {
            if (std::abs(block.mean - median) > most) { beyond.insert(block.index); }
        }
        blocks = std::max(blocks, of_axis.size());
    }
    return static_cast<double>(beyond.size()) / static_cast<double>(blocks);
}

// What can be done with a gyro that was turned.
std::string advice_on_rest(const Recording& recording, const SensorModel& model, const std::string& path,
                           const MotionRefusalOptions& options) {
    const TimeSpan still = still_part_of(recording);
    const double still_s = still.to_s - still.from_s;
    const Recording rest = part_of(recording, still);
    // What swings all the time is nowhere less still than elsewhere.
    if (!(still_s > 0.0) || share_turned(rest, model) > options.touched_most) {
        return "nowhere does it rest for a few seconds";
    }
    if (const auto refusal = diagnosis_refusal(rest)) {
        return fmt::format("its longest part at rest, from {:.6g} s to {:.6g} s, {}", still.from_s,
                           still.to_s, *refusal);
    }
    return fmt::format(
        "`gyrolog diagnose {} --still auto ...` judges its longest part at rest, {} from "
        "{:.6g} s on; --from and --to take another",
        path, format_duration(still_s), still.from_s);
}

// Of the recording.
double share_moved(const Recording& as_gyro, const MotionRefusalOptions& options) {
    const auto instants = std::max<std::int64_t>(1, std::llround(options.mean_s * as_gyro.rate_hz));
    std::vector<std::vector<BlockMean>> axes;
    for (const char* axis : axis_names) {
        const Column* column = as_gyro.find(std::string("g") + axis);
        if (column != nullptr) { axes.push_back(block_means(*column, as_gyro.segments, instants)); }
    }
    if (axes.empty() || axes.front().empty()) { return 0.0; }
    return share_beyond(axes, options.rest_most_g / unit_of_accelerometer_as_gyro().per_column_unit);
}

}  // namespace

bool is_moved(const Recording& as_gyro, const MotionRefusalOptions& options) {
    return share_moved(as_gyro, options) > options.touched_most;
}

Status refuse_moving_accelerometer(const Recording& as_gyro, const std::string& path,
                                   const MotionRefusalOptions& options) {
    if (exposure_of(as_gyro) == Exposure::known || !is_moved(as_gyro, options)) { return {}; }
    return Error{
        ErrorCode::failed,
        fmt::format("'{}': for {:.0f} % of the recording the accelerometer is turned or moved by more "
                    "than {:g} g, and nothing tells what it should have shown: columns ref_qw ref_qx "
                    "ref_qy ref_qz (orientation, sensor to world) tell it for the poses in which it "
                    "rests, and `gyrolog calibrate` does without them; --still auto takes the "
                    "longest part at rest, --from and --to a part that is named",
                    path, 100.0 * share_moved(as_gyro, options), options.rest_most_g)};
}

Status refuse_unreferenced_motion(const Recording& recording, const SensorModel& model,
                                  const std::string& path, const MotionRefusalOptions& options) {
    const double share = share_turned(recording, model);
    if (share <= options.touched_most) { return {}; }
    return Error{
        ErrorCode::failed,
        fmt::format("'{}': the gyro was turned for {:.0f} % of the time, and without a reference (columns "
                    "ref_x_dps ... or ref_qw ...) nothing tells what it should have shown: {}",
                    path, 100.0 * share, advice_on_rest(recording, model, path, options))};
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
