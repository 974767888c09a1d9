// A sensor with known faults that rests, is turned by hand, and is warmed.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/counter_random.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// y = M x + bias + temperature's part; the gyro's also K times the specific force.
struct FaultySensor {
    Matrix3 acc_M = {{{1.012, 0.0, 0.0}, {0.008, 0.991, 0.0}, {-0.006, 0.011, 1.004}}};
    Vector3 acc_bias_m_s2{0.21, -0.33, 0.12};
    Matrix3 gyro_M = {{{1.021, 0.006, -0.009}, {0.012, 0.984, 0.004}, {-0.007, 0.003, 1.008}}};
    Vector3 gyro_bias_rad_s{0.012, -0.021, 0.006};
    Matrix3 K_s_per_m = {{{1e-4, -4e-5, 2e-5}, {5e-5, 8e-5, -3e-5}, {-2e-5, 6e-5, -9e-5}}};
    // Per degC, degC^2, degC^3 from 25 degC on, of x; y and z have half and none of it.
    std::array<double, 3> gyro_c{};
    std::array<double, 3> acc_c{};
    double acc_noise_m_s2 = 0.02;  // of a sample
    double gyro_noise_rad_s = 0.001;
};

class MovedSensor {
public:
    MovedSensor(const FaultySensor& sensor, std::uint64_t seed, double rate_hz = 100.0)
        : sensor_(sensor), rate_hz_(rate_hz) {
        for (std::uint32_t i = 0; i < 6; ++i) { noise_.emplace_back(seed, 100 + i); }
    }

    // A direction that points upward at the begin.
    void place(const Vector3& up) { up_ = scaled(up, 1.0 / norm(up)); }

    void rest(double duration_s) { warm(duration_s, temperature_C_); }

    // At rest, along a straight line to that temperature.
    void warm(double duration_s, double to_C) {
        const std::size_t rows = rows_of(duration_s);
        const double from_C = temperature_C_;
        for (std::size_t i = 0; i < rows; ++i) {
            temperature_C_ = from_C + (to_C - from_C) * static_cast<double>(i) / static_cast<double>(rows);
            sample({});
        }
        temperature_C_ = to_C;
    }

    // About an axis that stands still, in the sensor's axes, with a rate that begins and ends softly.
    void turn(const Vector3& axis, double angle_rad, double duration_s = 1.5) {
        const Vector3 about = scaled(axis, 1.0 / norm(axis));
        const std::size_t rows = rows_of(duration_s);
        const Vector3 begin = up_;
        for (std::size_t i = 0; i < rows; ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(rows);
            const double done = share - std::sin(2.0 * std::numbers::pi * share) / (2.0 * std::numbers::pi);
            const double rate = (1.0 - std::cos(2.0 * std::numbers::pi * share)) / duration_s;
            up_ = carried(begin, about, angle_rad * done);
            sample(scaled(about, angle_rad * rate));
        }
        up_ = carried(begin, about, angle_rad);
    }

    // Along the shortest way.
    void tilt_to(const Vector3& up, double duration_s = 1.5) {
        const Vector3 to = scaled(up, 1.0 / norm(up));
        const Vector3 axis = cross(to, up_);
        // Opposite: about any axis across.
        const Vector3 across =
            std::abs(up_[0]) < 0.9 ? cross(up_, {1.0, 0.0, 0.0}) : cross(up_, {0.0, 1.0, 0.0});
        turn(norm(axis) > 1e-6 ? axis : across, angle_rad(up_, to), duration_s);
    }

    void set_temperature_C(double temperature_C) { temperature_C_ = temperature_C; }

    const Vector3& up() const { return up_; }

    Recording recording(const std::string& name = "moved.csv", bool with_temperature = false,
                        bool with_reference = false, bool with_force = true) const {
        Recording recording;
        recording.name = name;
        recording.rate_hz = rate_hz_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            recording.columns.push_back({std::string("g") + axis_names[axis], "rad/s", rate_[axis]});
        }
        for (std::size_t axis = 0; axis < 3 && with_force; ++axis) {
            recording.columns.push_back({std::string("a") + axis_names[axis], "m/s^2", force_[axis]});
        }
        if (with_temperature) { recording.columns.push_back({"temp", "degC", temperature_}); }
        for (std::size_t axis = 0; axis < 3 && with_reference; ++axis) {
            recording.columns.push_back({std::string("ref_") + axis_names[axis], "rad/s", true_rate_[axis]});
        }
        recording.segments = {{0, rate_[0].size(), 0}};
        return recording;
    }

private:
    std::size_t rows_of(double duration_s) const {
        return static_cast<std::size_t>(std::llround(duration_s * rate_hz_));
    }

    // A direction of the world, seen by what turns by the angle about the axis.
    static Vector3 carried(const Vector3& up, const Vector3& axis, double angle_rad) {
        const Vector3 aside = cross(axis, up);
        Vector3 carried{};
        for (std::size_t i = 0; i < 3; ++i) {
            carried[i] = up[i] * std::cos(angle_rad) - aside[i] * std::sin(angle_rad) +
                         axis[i] * dot(axis, up) * (1.0 - std::cos(angle_rad));
        }
        return carried;
    }

    static double thermal(const std::array<double, 3>& c, double temperature_C, std::size_t axis) {
        constexpr std::array share{1.0, 0.5, 0.0};
        const double t = temperature_C - 25.0;
        return share[axis] * (c[0] + (c[1] + c[2] * t) * t) * t;
    }

    void sample(const Vector3& rate) {
        const Vector3 force = scaled(up_, standard_gravity_m_s2);
        const Vector3 a = product(sensor_.acc_M, force);
        const Vector3 w = product(sensor_.gyro_M, rate);
        const Vector3 k = product(sensor_.K_s_per_m, force);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            force_[axis].push_back(a[axis] + sensor_.acc_bias_m_s2[axis] +
                                   thermal(sensor_.acc_c, temperature_C_, axis) +
                                   sensor_.acc_noise_m_s2 * noise_[axis].normal(count_));
            rate_[axis].push_back(w[axis] + k[axis] + sensor_.gyro_bias_rad_s[axis] +
                                  thermal(sensor_.gyro_c, temperature_C_, axis) +
                                  sensor_.gyro_noise_rad_s * noise_[3 + axis].normal(count_));
            true_rate_[axis].push_back(rate[axis]);
        }
        temperature_.push_back(temperature_C_);
        ++count_;
    }

    FaultySensor sensor_;
    double rate_hz_;
    std::vector<RandomStream> noise_;
    std::uint64_t count_ = 0;
    Vector3 up_{0.0, 0.0, 1.0};
    double temperature_C_ = 25.0;
    std::array<std::vector<double>, 3> rate_;
    std::array<std::vector<double>, 3> force_;
    std::array<std::vector<double>, 3> true_rate_;
    std::vector<double> temperature_;
};

inline const std::vector<Vector3>& faces() {
    static const std::vector<Vector3> faces{{1, 0, 0},  {0, 1, 0}, {-1, 0, 0},
                                            {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    return faces;
}

inline const std::vector<Vector3>& edges() {
    static const std::vector<Vector3> edges{{1, 1, 0},  {1, -1, 0}, {1, 0, 1},
                                            {-1, 0, 1}, {0, 1, 1},  {0, -1, 1}};
    return edges;
}

inline void rest_in(MovedSensor& moved, const std::vector<Vector3>& poses, double duration_s = 2.0) {
    for (const Vector3& pose : poses) {
        moved.tilt_to(pose);
        moved.rest(duration_s);
    }
}

// Six faces, six edges, and a turn about each axis.
inline void whole_session(MovedSensor& moved, double turn_error_rad = 0.0, double rest_s = 2.0) {
    moved.rest(rest_s);
    rest_in(moved, faces(), rest_s);
    rest_in(moved, edges(), rest_s);
    for (const Vector3& up : {Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}}) {
        moved.tilt_to(up);
        moved.rest(rest_s);
        moved.turn(up, 2.0 * std::numbers::pi + turn_error_rad, 3.0);
        moved.rest(rest_s);
    }
}

}  // namespace gyrolog
