// Test side only: a sensor that is set down on each of its six faces, with the orientation that a turntable
// or a tracker tells. Its rates are nought: what a simulation like it fills in.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/orientation_rate.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct SixPoses {
    double rate_hz = 100.0;
    double rest_s = 20.0;
    double turn_s = 2.0;
};

class PosedRecording {
public:
    explicit PosedRecording(const SixPoses& poses = {}) : poses_(poses) {
        rest();
        for (const auto& [axis, angle_deg] : turns()) {
            turn(axis, angle_deg * rad_per_deg);
            rest();
        }
    }

    Recording recording() const {
        Recording recording;
        recording.name = "poses.csv";
        recording.rate_hz = poses_.rate_hz;
        recording.stamps = StampKind::sampling;
        const std::size_t rows = orientation_.size();
        for (std::size_t row = 0; row < rows; ++row) {
            recording.t_s.push_back(static_cast<double>(row) / poses_.rate_hz);
        }
        for (const char* axis : axis_names) {
            recording.columns.push_back({std::string("g") + axis, "rad/s", std::vector<double>(rows, 0.0)});
        }
        for (std::size_t part = 0; part < 4; ++part) {
            std::vector<double> values;
            for (const Quaternion& q : orientation_) { values.push_back(q.at(part)); }
            recording.columns.push_back({std::string("ref_q") + "wxyz"[part], "", std::move(values)});
        }
        recording.segments = {{0, rows, 0}};
        return recording;
    }

private:
    struct Turn {
        std::size_t axis;
        double angle_deg;
    };

    // Upward: z, y, -z, -y, -x, x.
    static constexpr std::array<Turn, 5> turns() {
        return {{{0, 90.0}, {0, 90.0}, {0, 90.0}, {2, 90.0}, {2, 180.0}}};
    }

    std::size_t rows_of(double duration_s) const {
        return static_cast<std::size_t>(std::llround(duration_s * poses_.rate_hz));
    }

    void rest() { orientation_.insert(orientation_.end(), rows_of(poses_.rest_s), now_); }

    // Softly begun and ended.
    void turn(std::size_t axis, double angle_rad) {
        const Quaternion from = now_;
        const std::size_t rows = rows_of(poses_.turn_s);
        for (std::size_t i = 0; i < rows; ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(rows);
            orientation_.push_back(
                turned(from, axis, angle_rad * (share - std::sin(2.0 * pi * share) / (2.0 * pi))));
        }
        now_ = turned(from, axis, angle_rad);
    }

    static Quaternion turned(const Quaternion& q, std::size_t axis, double angle_rad) {
        const double w = std::cos(0.5 * angle_rad);
        std::array<double, 3> v{};
        v.at(axis) = std::sin(0.5 * angle_rad);
        return {q[0] * w - q[1] * v[0] - q[2] * v[1] - q[3] * v[2],
                q[0] * v[0] + q[1] * w + q[2] * v[2] - q[3] * v[1],
                q[0] * v[1] + q[2] * w + q[3] * v[0] - q[1] * v[2],
                q[0] * v[2] + q[3] * w + q[1] * v[1] - q[2] * v[0]};
    }

    SixPoses poses_;
    Quaternion now_{1.0, 0.0, 0.0, 0.0};
    std::vector<Quaternion> orientation_;
};

}  // namespace gyrolog
