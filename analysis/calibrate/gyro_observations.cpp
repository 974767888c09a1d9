#include "analysis/calibrate/gyro_observations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "analysis/recording/neighbour_scatter.hpp"

namespace gyrolog {
namespace {

class Observer {
public:
    Observer(std::span<const InertialSignals> recordings, const Phases& phases,
             const std::optional<AccelerometerCalibration>& accelerometer, double gravity_m_s2,
             const GyroObservationOptions& options)
        : recordings_(recordings),
          phases_(phases),
          accelerometer_(accelerometer),
          gravity_m_s2_(gravity_m_s2),
          options_(options) {
        if (accelerometer) { correction_ = *inverse(accelerometer->M); }
    }

    GyroObservations observe() {
        for (const InertialSignals& signals : recordings_) {
            result_.has_force = result_.has_force || (signals.has_force() && signals.has_rate());
            has_reference_ = has_reference_ || (signals.has_reference() && signals.has_rate());
        }
        for (const Rest& rest : phases_.rests) { add_rest(rest); }
        if (has_reference_) {
            for (const InertialSignals& signals : recordings_) { add_reference(signals); }
            return std::move(result_);
        }
        if (options_.turn_rad) { add_turns(); }
        if (accelerometer_) {
            for (const Move& move : phases_.moves) { add_move(move); }
        }
        return std::move(result_);
    }

private:
    Vector3 true_force(const Vector3& measured) const {
        return accelerometer_ ? product(correction_, difference(measured, accelerometer_->bias_m_s2))
                              : measured;
    }

    Vector3 mean_force(const InertialSignals& signals, std::size_t first, std::size_t rows) const {
        return signals.has_force() ? true_force(mean_of(signals.force_m_s2, first, rows)) : Vector3{};
    }

    Vector3 noise_of_mean(double duration_s) const { return phases_.scatter.rate_sd_rad_s(duration_s); }

    void add_rest(const Rest& rest) {
        const InertialSignals& signals = recordings_[rest.recording];
        if (!signals.has_rate()) { return; }
        result_.means.push_back({ObservationKind::rest, Vector3{}, mean_force(signals, rest.first, rest.rows),
                                 rest.rate_rad_s, noise_of_mean(rest.duration_s)});
    }

    // In blocks, so that a lag of the sensor or of the reference moves little from one into the next.
    void add_reference(const InertialSignals& signals) {
        if (!signals.has_reference() || !signals.has_rate()) { return; }
        const auto rows =
            static_cast<std::size_t>(std::max(1.0, std::round(options_.block_s * signals.recording.rate_hz)));
        Vector3 sd{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Column* column = signals.recording.find(std::string("g") + axis_names[axis]);
            sd[axis] = std::hypot(
                neighbour_scatter(*column, signals.recording.segments) / std::sqrt(static_cast<double>(rows)),
                phases_.scatter.rate_floor_rad_s[axis]);
        }
        for (const Segment& segment : signals.recording.segments) {
            for (std::size_t i = segment.first; i + rows <= segment.first + segment.count; i += rows) {
                const Vector3 rate = mean_of(signals.reference_rad_s, i, rows);
                result_.means.push_back({ObservationKind::reference, rate, mean_force(signals, i, rows),
                                         mean_of(signals.rate_rad_s, i, rows), sd});
            }
        }
    }

    std::size_t first_row(const Move& move) const {
        const Rest& before = phases_.rests[move.before];
        return before.first + before.rows;
    }

    std::size_t rows_between(const Move& move) const {
        return phases_.rests[move.after].first - first_row(move);
    }

    // Upward, in orthogonal axes, of length one.
    Vector3 up_of(std::size_t rest) const {
        const Vector3 force = true_force(phases_.rests[rest].force_m_s2);
        return scaled(force, 1.0 / norm(force));
    }

    // The rates less the bias of the rests at either end, as it came.
    Vector3 turned_rad(const Move& move) const {
        const InertialSignals& signals = recordings_[phases_.rests[move.before].recording];
        const std::size_t rows = rows_between(move);
        if (rows == 0) { return {}; }
        Vector3 turned = mean_of(signals.rate_rad_s, first_row(move), rows);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            turned[axis] -=
                (phases_.rests[move.before].rate_rad_s[axis] + phases_.rests[move.after].rate_rad_s[axis]) /
                2.0;
        }
        return scaled(turned, static_cast<double>(rows) * signals.row_s());
    }

    bool is_upright(const Move& move) const {
        return angle_rad(up_of(move.before), up_of(move.after)) < options_.upright_rad;
    }

    // Moves about an upright axis that follow each other are parts of one turn, until they make it up.
    void add_turns() {
        Move whole{};
        double sum_rad = 0.0;
        std::vector<double> left_rad;
        const auto close = [&] {
            if (std::abs(sum_rad) > options_.move_least_rad) { left_rad.push_back(sum_rad); }
            sum_rad = 0.0;
        };
        for (const Move& move : phases_.moves) {
            const InertialSignals& signals = recordings_[phases_.rests[move.before].recording];
            if (!signals.has_force() || !signals.has_rate() || rows_between(move) == 0) { continue; }
            const bool goes_on = sum_rad != 0.0 && whole.after == move.before;
            if (!goes_on || !is_upright(move)) { close(); }
            if (!is_upright(move)) { continue; }
            if (sum_rad == 0.0) { whole.before = move.before; }
            whole.after = move.after;
            sum_rad += dot(turned_rad(move), up_of(move.before));
            const double turns = std::round(std::abs(sum_rad) / *options_.turn_rad);
            const double wanted_rad = turns * *options_.turn_rad;
            if (turns > 0.0 &&
                std::abs(std::abs(sum_rad) - wanted_rad) < options_.turn_share * *options_.turn_rad) {
                add_turn(whole, std::copysign(wanted_rad, sum_rad));
                sum_rad = 0.0;
            }
        }
        close();
        for (const double angle_rad : left_rad) {
            const std::string turned = std::to_string(std::lround(std::abs(angle_rad) * deg_per_rad));
            const std::string wanted = std::to_string(std::lround(*options_.turn_rad * deg_per_rad));
            result_.notes.push_back(std::string("a turn by some ")
                                        .append(turned)
                                        .append(" deg about an upright axis is no multiple of --turn ")
                                        .append(wanted)
                                        .append(" deg; its size was not used"));
        }
    }

    void add_turn(const Move& whole, double turn_rad) {
        const InertialSignals& signals = recordings_[phases_.rests[whole.before].recording];
        const std::size_t first = first_row(whole);
        const std::size_t rows = rows_between(whole);
        const double duration_s = static_cast<double>(rows) * signals.row_s();
        Vector3 up = up_of(whole.before);
        const Vector3 after = up_of(whole.after);
        for (std::size_t axis = 0; axis < 3; ++axis) { up[axis] += after[axis]; }
        up = scaled(up, 1.0 / norm(up));
        const double axis_sd_rad = std::hypot(
            options_.axis_sd_rad, angle_rad(up_of(whole.before), after) / 2.0, direction_sd_rad(up));
        Vector3 sd = noise_of_mean(duration_s);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double across = std::sqrt(std::max(0.0, 1.0 - up[axis] * up[axis]));
            sd[axis] = std::hypot(sd[axis], up[axis] * options_.turn_sd_rad / duration_s,
                                  across * turn_rad * axis_sd_rad / duration_s);
        }
        result_.means.push_back({ObservationKind::turn, scaled(up, turn_rad / duration_s),
                                 mean_force(signals, first, rows), mean_of(signals.rate_rad_s, first, rows),
                                 sd});
        ++result_.turns;
    }

    // Across a direction, of what the accelerometer's parameters leave open: da = -M^-1 (dM a + db). What is
    // not determined lies anywhere within its tolerance (GUM 4.3.7).
    double direction_sd_rad(const Vector3& up) const {
        const double open_axes_rad = options_.tolerance.cross_axis / std::sqrt(3.0);
        if (!accelerometer_) {
            const double open_bias_rad = options_.tolerance.bias_m_s2 / gravity_m_s2_ / std::sqrt(3.0);
            return std::hypot(open_axes_rad, open_bias_rad);
        }
        const Matrix& covariance = accelerometer_->covariance;
        const Vector3 a = scaled(up, gravity_m_s2_);
        std::vector<Vector3> derivatives;
        for (const std::string& name : accelerometer_->names) {
            // "M_yx" is row y, column x; "bias_y" row y.
            const bool is_bias = name.starts_with("bias");
            const auto row = static_cast<std::size_t>(name[is_bias ? 5 : 2] - 'x');
            Vector3 change{};
            change[row] = is_bias ? 1.0 : a[static_cast<std::size_t>(name[3] - 'x')];
            const Vector3 moved = product(correction_, change);
            derivatives.push_back(difference(moved, scaled(up, dot(moved, up))));
        }
        double variance = 0.0;
        for (std::size_t i = 0; i < derivatives.size(); ++i) {
            for (std::size_t j = 0; j < derivatives.size(); ++j) {
                variance += covariance(i, j) * dot(derivatives[i], derivatives[j]);
            }
        }
        return std::hypot(std::sqrt(variance / 2.0) / gravity_m_s2_,
                          accelerometer_->has_misalignment ? 0.0 : open_axes_rad);
    }

    void add_move(const Move& move) {
        const Rest& before = phases_.rests[move.before];
        const Rest& after = phases_.rests[move.after];
        const InertialSignals& signals = recordings_[before.recording];
        if (!signals.has_force() || !signals.has_rate()) { return; }
        GravityMove gravity;
        gravity.row_s = signals.row_s();
        const std::size_t first = first_row(move) - 1;
        const std::size_t rows = after.first - first + 1;
        const double duration_s = static_cast<double>(rows) * gravity.row_s;
        if (duration_s > options_.move_most_s || norm(turned_rad(move)) < options_.move_least_rad) { return; }
        gravity.up_before = up_of(move.before);
        gravity.up_after = up_of(move.after);
        for (std::size_t row = first; row < first + rows; ++row) {
            Vector3 rate{};
            Vector3 force{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                rate[axis] = signals.rate_rad_s[axis][row];
                force[axis] = signals.force_m_s2[axis][row];
            }
            gravity.measured_rad_s.push_back(rate);
            gravity.force_m_s2.push_back(true_force(force));
        }
        const double direction_rad = norm(phases_.scatter.force_m_s2_sqrt_s) / std::sqrt(3.0) / gravity_m_s2_;
        const double walk_rad =
            norm(phases_.scatter.rate_rad_s_sqrt_s) / std::sqrt(3.0) * std::sqrt(duration_s);
        const double of_means_rad = std::hypot(direction_rad / std::sqrt(before.duration_s),
                                               direction_rad / std::sqrt(after.duration_s), walk_rad);
        gravity.sd_rad =
            std::hypot(of_means_rad, direction_sd_rad(gravity.up_before), direction_sd_rad(gravity.up_after));
        result_.moves.push_back(std::move(gravity));
    }

    std::span<const InertialSignals> recordings_;
    const Phases& phases_;
    const std::optional<AccelerometerCalibration>& accelerometer_;
    double gravity_m_s2_;
    const GyroObservationOptions& options_;
    Matrix3 correction_ = identity_matrix;
    bool has_reference_ = false;
    GyroObservations result_;
};

}  // namespace

const char* words_of(ObservationKind kind) {
    switch (kind) {
        case ObservationKind::rest:
            return "rests";
        case ObservationKind::turn:
            return "turns";
        case ObservationKind::reference:
            return "reference rates";
        case ObservationKind::gravity:
            return "moves of gravity";
    }
    return "";
}

GyroObservations gyro_observations(std::span<const InertialSignals> recordings, const Phases& phases,
                                   const std::optional<AccelerometerCalibration>& accelerometer,
                                   double gravity_m_s2, const GyroObservationOptions& options) {
    return Observer(recordings, phases, accelerometer, gravity_m_s2, options).observe();
}

}  // namespace gyrolog
