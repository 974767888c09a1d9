// What is of a sensor at rest only, such as its noise model, is not made of a recording in motion.
#pragma once

#include <string>

#include "analysis/noise/analyze.hpp"
#include "analysis/recording/disturbances.hpp"
#include "analysis/recording/recording.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

struct MotionRefusalOptions {
    // Of the rows: what moves for less is a touch, as a disturbance is (DisturbanceOptions::together_share).
    // The report warns of it.
    double touched_most = DisturbanceOptions().together_share;
};

// Error: failed where the report is of a recording in motion (AnalysisReport::is_of_motion()), with what to
// do. `result` is what is not made then: "a model".
Status refuse_motion(const AnalysisReport& report, const Recording& recording, const std::string& path,
                     const std::string& result, const MotionRefusalOptions& options = {});

}  // namespace gyrolog
