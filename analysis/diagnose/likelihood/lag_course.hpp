// The lag course tells when the samples of a moving sensor were really taken, as far as the motion tells: by
// how many sample periods what they show runs ahead of their stamps. In windows of a second, the misfit of
// the recording to the model's answer is taken at whole lags about a course that is followed through the
// record. The noise counts as white, with a constant in each window that is as large as the drift.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

// From `slot` on the samples are `samples` further ahead than before.
struct LagStep {
    std::size_t slot = 0;
    int samples = 0;
};

struct LagSlope {
    double rel = 0.0;  // periods a sample: below 0 where samples come too fast for their stamps
    double sd = 0.0;
};

class LagCourse {
public:
    // `recording` covers the grid of `prediction`, which moves.
    LagCourse(const Prediction& prediction, const Recording& recording);

    // The slope is the steady one that fits best.
    LagSlope slope() const;
    // The steps are the fewest that pay for the freedom of their places and sizes.
    std::vector<LagStep> steps() const;

private:
    struct Axis {
        std::vector<float> seen;  // by slot, without the bias
        const std::vector<float>* expected = nullptr;
        std::vector<float> smooth_seen;
        std::vector<float> smooth_expected;
        double per_variance = 0.0;
        double drift_rows = 0.0;  // so many samples' white noise has the variance of the drift; 0: any
    };

    std::size_t shifted(std::size_t slot, int lag) const;
    double misfit_nats(std::size_t begin, std::size_t end, int lag) const;
    void follow();
    void take_bias_off();
    double nats_at(std::size_t window, double lag) const;
    double middle_slot(std::size_t window) const;
    double slope_nats(double rel) const;
    struct Pair {
        std::size_t first_slot = 0;
        std::size_t second_slot = 0;
        int middle = 0;  // the lag between
    };
    Pair best_pair(std::size_t first, std::size_t last, int before, int after) const;
    std::size_t best_place(std::size_t first, std::size_t last, int before, int after) const;
    double squares_nats(std::size_t slot, int lag) const;
    double step_nats() const;
    std::vector<LagStep> merged(std::vector<LagStep> steps) const;

    std::size_t length_;
    std::size_t window_slots_;
    std::size_t smooth_slots_;
    std::size_t stride_;  // a running mean has little new from one slot to the next
    std::vector<bool> present_;
    std::vector<Axis> axes_;
    std::vector<int> centre_;                // by window
    std::vector<std::vector<double>> nats_;  // by window, by lag from centre - reach on
};

}  // namespace gyrolog
