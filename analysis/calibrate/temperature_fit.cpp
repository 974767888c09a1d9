#include "analysis/calibrate/temperature_fit.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/numerics/robust_spread.hpp"

namespace gyrolog {
namespace {

struct Block {
    double temperature_C = 0.0;  // smooth
    double read_C = 0.0;         // as the thermometer had it
    Vector3 mean{};
};

struct HeldPose {
    std::size_t recording = 0;
    Vector3 force_m_s2{};
    std::vector<std::size_t> rests;
    double duration_s = 0.0;
    std::vector<Block> blocks;

    double range_C() const {
        const auto [low, high] = std::ranges::minmax_element(blocks, {}, &Block::temperature_C);
        return blocks.empty() ? 0.0 : high->temperature_C - low->temperature_C;
    }
};

bool is_same_pose(const HeldPose& pose, const Rest& rest, double pose_rad) {
    if (pose.recording != rest.recording) { return false; }
    // Without an accelerometer there is one.
    if (norm(pose.force_m_s2) == 0.0) { return true; }
    return angle_rad(pose.force_m_s2, rest.force_m_s2) < pose_rad;
}

std::vector<HeldPose> poses_of(std::span<const InertialSignals> recordings, std::span<const Rest> rests,
                               double pose_rad) {
    std::vector<HeldPose> poses;
    for (std::size_t i = 0; i < rests.size(); ++i) {
        if (!recordings[rests[i].recording].has_temperature()) { continue; }
        auto pose = std::ranges::find_if(
            poses, [&](const HeldPose& one) { return is_same_pose(one, rests[i], pose_rad); });
        if (pose == poses.end()) {
            poses.push_back({rests[i].recording, rests[i].force_m_s2, {}, 0.0, {}});
            pose = poses.end() - 1;
        }
        pose->rests.push_back(i);
        pose->duration_s += rests[i].duration_s;
    }
    return poses;
}

// Of what the thermometer read in these rows; `otherwise` where it read nothing.
double mean_reading_C(const Column* column, std::size_t first, std::size_t rows, double otherwise) {
    double sum_C = 0.0;
    double known = 0.0;
    for (std::size_t row = first; column != nullptr && row < first + rows; ++row) {
        const double value_C = column->value(row);
        if (!std::isfinite(value_C)) { continue; }
        sum_C += value_C;
        known += 1.0;
    }
    return known > 0.0 ? sum_C / known : otherwise;
}

// About a jump of the temperature the smooth one is what the sensor never had.
void leave_out_jumps(std::vector<Block>& blocks, const TemperatureFitOptions& options) {
    if (blocks.empty()) { return; }
    std::vector<double> errors_C;
    errors_C.reserve(blocks.size());
    for (const Block& block : blocks) { errors_C.push_back(std::abs(block.read_C - block.temperature_C)); }
    const auto [low, high] = std::ranges::minmax_element(blocks, {}, &Block::read_C);
    const double range_C = high->read_C - low->read_C;
    const double most_C = options.jump_sigmas * per_median_absolute_deviation * median_of(errors_C) +
                          options.jump_share * range_C;
    std::erase_if(blocks,
                  [&](const Block& block) { return std::abs(block.read_C - block.temperature_C) > most_C; });
}

void cut(HeldPose& pose, const InertialSignals& signals, std::span<const Rest> rests,
         const VectorTrack& track, const TemperatureFitOptions& options) {
    const double block_s =
        std::max(options.block_s, pose.duration_s / static_cast<double>(options.blocks_most));
    const std::size_t rows =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(block_s / signals.row_s())));
    const Column* const read = signals.recording.find("temp");
    for (const std::size_t i : pose.rests) {
        const Rest& rest = rests[i];
        for (std::size_t first = rest.first; first + rows <= rest.first + rest.rows; first += rows) {
            const double smooth_C = mean_of(signals.temperature_C, first, rows);
            pose.blocks.push_back(
                {smooth_C, mean_reading_C(read, first, rows, smooth_C), mean_of(track, first, rows)});
        }
    }
    leave_out_jumps(pose.blocks, options);
}

// A least-squares line of one axis: columns are a constant a pose, then powers of t.
struct Regression {
    std::vector<double> c;  // of the powers
    Matrix covariance;      // of c, for residuals of variance one
    std::vector<double> residuals;
    double squares = 0.0;
    double degrees = 0.0;
};

// Powers are of t / span, so that none is large; back to degC at the end. Nothing where the temperatures do
// not tell the powers apart.
std::optional<Regression> regress(std::span<const HeldPose> poses, std::size_t axis, std::size_t order,
                                  double reference_C, double span_C) {
    const std::size_t size = poses.size() + order;
    Matrix normal(size, size);
    std::vector<double> right(size, 0.0);
    std::vector<double> row(size);
    const auto each_block = [&](const auto& take) {
        for (std::size_t p = 0; p < poses.size(); ++p) {
            for (const Block& block : poses[p].blocks) {
                std::ranges::fill(row, 0.0);
                row[p] = 1.0;
                double power = 1.0;
                for (std::size_t k = 0; k < order; ++k) {
                    row[poses.size() + k] = power *= (block.temperature_C - reference_C) / span_C;
                }
                // Less the first block's: the sums are then of small numbers.
                take(block.mean[axis] - poses[p].blocks.front().mean[axis]);
            }
        }
    };
    Regression result;
    each_block([&](double value) {
        for (std::size_t i = 0; i < size; ++i) {
            right[i] += row[i] * value;
            for (std::size_t j = 0; j <= i; ++j) { normal(i, j) += row[i] * row[j]; }
        }
        result.degrees += 1.0;
    });
    result.degrees -= static_cast<double>(size);
    const CholeskyFactor factor(normal);
    if (!factor.is_positive_definite()) { return std::nullopt; }
    const std::vector<double> at = factor.solve(right);
    each_block([&](double value) {
        for (std::size_t i = 0; i < size; ++i) { value -= row[i] * at[i]; }
        result.residuals.push_back(value);
        result.squares += value * value;
    });
    const Matrix inverse = factor.inverse();
    result.covariance = Matrix(order, order);
    for (std::size_t k = 0; k < order; ++k) {
        const double unit_k = std::pow(span_C, -static_cast<double>(k + 1));
        result.c.push_back(at[poses.size() + k] * unit_k);
        for (std::size_t l = 0; l < order; ++l) {
            const double unit_l = std::pow(span_C, -static_cast<double>(l + 1));
            result.covariance(k, l) = inverse(poses.size() + k, poses.size() + l) * unit_k * unit_l;
        }
    }
    return result;
}

// Of neighbours; not below 0: what alternates makes no mean better known here.
double neighbour_correlation(const std::vector<double>& residuals) {
    double products = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < residuals.size(); ++i) {
        squares += residuals[i] * residuals[i];
        if (i > 0) { products += residuals[i] * residuals[i - 1]; }
    }
    return squares > 0.0 ? std::clamp(products / squares, 0.0, 0.99) : 0.0;
}

double independent_share(double correlation) { return (1.0 - correlation) / (1.0 + correlation); }

TemperaturePolynomial fit_axis(std::span<const HeldPose> poses, std::size_t axis, std::size_t order_most,
                               const TemperatureCalibration& range, double chance_least) {
    TemperaturePolynomial polynomial;
    const double span_C = range.to_C - range.from_C;
    const auto of_order = [&](std::size_t order) {
        return regress(poses, axis, order, range.reference_C, span_C);
    };
    std::size_t order = order_most;
    std::optional<Regression> fullest = of_order(order);
    while (!fullest && order > 0) { fullest = of_order(--order); }
    if (!fullest) { return polynomial; }
    Regression fit = *std::move(fullest);
    // Of the fullest of the fits: what an order lacks would look like slow noise.
    polynomial.correlation = neighbour_correlation(fit.residuals);
    const double share = independent_share(polynomial.correlation);
    while (order > 0) {
        Regression lower = *of_order(order - 1);
        const double nu = std::max(1.0, fit.degrees * share);
        const double t = students_t_upper_quantile(nu, chance_least / 2.0);
        polynomial.F[order - 1] = (lower.squares - fit.squares) / (fit.squares / nu);
        polynomial.F_needed[order - 1] = t * t;  // F(1, nu) is the square of Student's t
        if (polynomial.F[order - 1] > polynomial.F_needed[order - 1]) { break; }
        fit = std::move(lower);
        --order;
    }
    polynomial.order = order;
    const double variance = fit.squares / std::max(1.0, fit.degrees);
    polynomial.residual_sd = std::sqrt(variance);
    polynomial.covariance = fit.covariance;
    for (double& value : polynomial.covariance.values()) { value *= variance / share; }
    for (std::size_t k = 0; k < order; ++k) {
        polynomial.c[k] = fit.c[k];
        polynomial.c_sd[k] = std::sqrt(polynomial.covariance(k, k));
    }
    return polynomial;
}

}  // namespace

Vector3 TemperatureCalibration::offset(double temperature_C) const {
    const double t = std::clamp(temperature_C, from_C, to_C) - reference_C;
    Vector3 offset{};
    for (std::size_t axis = 0; axis < offset.size(); ++axis) {
        const auto& c = axes[axis].c;
        offset[axis] = (c[0] + (c[1] + c[2] * t) * t) * t;
    }
    return offset;
}

bool TemperatureCalibration::follows() const {
    return std::ranges::any_of(axes, [](const TemperaturePolynomial& axis) { return axis.order > 0; });
}

TemperatureResult fit_temperature(std::span<const InertialSignals> recordings, std::span<const Rest> rests,
                                  CalibratedSensor sensor, const TemperatureFitOptions& options) {
    TemperatureResult result;
    std::vector<HeldPose> poses = poses_of(recordings, rests, options.pose_rad);
    for (HeldPose& pose : poses) {
        const InertialSignals& signals = recordings[pose.recording];
        const bool is_gyro = sensor == CalibratedSensor::gyro;
        if (!(is_gyro ? signals.has_rate() : signals.has_force())) { continue; }
        cut(pose, signals, rests, is_gyro ? signals.rate_rad_s : signals.force_m_s2, options);
        result.range_C = std::max(result.range_C, pose.range_C());
    }
    std::erase_if(poses, [](const HeldPose& pose) { return pose.blocks.size() < 2; });
    std::size_t order_most = 0;
    while (order_most < temperature_orders && result.range_C >= options.range_C[order_most]) { ++order_most; }
    if (order_most == 0) { return result; }
    TemperatureCalibration calibration;
    calibration.from_C = poses.front().blocks.front().temperature_C;
    calibration.to_C = calibration.from_C;
    for (const HeldPose& pose : poses) {
        for (const Block& block : pose.blocks) {
            calibration.from_C = std::min(calibration.from_C, block.temperature_C);
            calibration.to_C = std::max(calibration.to_C, block.temperature_C);
        }
        calibration.blocks += pose.blocks.size();
    }
    if (calibration.blocks < poses.size() + 2 * temperature_orders) { return result; }
    // A whole number: it stands in every file that has the polynomial.
    calibration.reference_C = std::round((calibration.from_C + calibration.to_C) / 2.0);
    for (std::size_t axis = 0; axis < calibration.axes.size(); ++axis) {
        calibration.axes[axis] = fit_axis(poses, axis, order_most, calibration, options.chance_least);
    }
    result.calibration = std::move(calibration);
    return result;
}

}  // namespace gyrolog
