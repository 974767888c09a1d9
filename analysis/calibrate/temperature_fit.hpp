// A sensor's bias over the temperature, from rests in which the temperature changes and the pose does not.
//
// Each rest is cut into blocks; their means follow alpha(pose) + c1 t + c2 t^2 + c3 t^3, t = T - T_ref, by
// least squares: alpha takes up the bias and what gravity and its sensitivity do in that pose. An order is
// tried where the pose has seen the range that its effect's definition asks for (effects/temp_linear.cpp 5
// degC, temp_quadratic.cpp 10, temp_cubic.cpp 20), the highest first; it stays where its last term takes away
// more than chance does: F = (RSS_{p-1} - RSS_p) / (RSS_p / nu) against F(1, nu) (N. R. Draper, H. Smith,
// Applied Regression Analysis, 3rd ed. 1998, sec. 6.1, extra sum of squares). The residuals of neighbouring
// blocks are alike: nu and the covariance are those of n (1 - r) / (1 + r) blocks, r their correlation (G. V.
// Bayley, J. M. Hammersley, J. R. Stat. Soc. Suppl. 8 (1946) 184-197, of a first-order autoregression).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/calibrate/rests.hpp"
#include "analysis/numerics/matrix.hpp"

namespace gyrolog {

inline constexpr std::size_t temperature_orders = 3;

struct TemperatureFitOptions {
    double block_s = 1.0;
    std::size_t blocks_most = 300;        // of a pose: longer blocks where there would be more
    double pose_rad = 2.0 * rad_per_deg;  // what is nearer is the same pose
    std::array<double, temperature_orders> range_C{5.0, 10.0, 20.0};
    double chance_least = 0.01;  // of F, for a term to stay
    // Where the smooth temperature is farther from what was read than so many deviations of the thermometer
    // and this share of the range, it jumped, and the block is left out. A normal deviation is beyond four
    // once in 16 000 times; what is within the share puts a line off by as small a share.
    double jump_sigmas = 4.0;
    double jump_share = 0.01;
};

struct TemperaturePolynomial {
    std::size_t order = 0;                       // 0: the bias does not follow the temperature
    std::array<double, temperature_orders> c{};  // rad/s or m/s^2 per degC, degC^2, degC^3
    std::array<double, temperature_orders> c_sd{};
    Matrix covariance;                                  // of c, order by order
    double residual_sd = 0.0;                           // of the blocks' means
    double correlation = 0.0;                           // of neighbouring blocks' residuals
    std::array<double, temperature_orders> F{};         // of each order's last term; 0: not tried
    std::array<double, temperature_orders> F_needed{};  // for it to stay
};

struct TemperatureCalibration {
    double reference_C = 0.0;
    double from_C = 0.0;
    double to_C = 0.0;
    std::size_t blocks = 0;
    std::array<TemperaturePolynomial, 3> axes;

    // Of the temperature; beyond the range that was seen, as at its end.
    Vector3 offset(double temperature_C) const;
    bool follows() const;  // an axis has an order above 0
};

enum class CalibratedSensor { gyro, accelerometer };

struct TemperatureResult {
    std::optional<TemperatureCalibration> calibration;
    double range_C = 0.0;  // the widest of a pose
};

// No calibration where no pose has seen the first order's range.
TemperatureResult fit_temperature(std::span<const InertialSignals> recordings, std::span<const Rest> rests,
                                  CalibratedSensor sensor, const TemperatureFitOptions& options = {});

}  // namespace gyrolog
