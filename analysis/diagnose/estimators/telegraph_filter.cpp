#include "analysis/diagnose/estimators/telegraph_filter.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

namespace {

// A Kalman filter of independent first-order parts of which the sum is measured.
template <int parts>
struct Filter {
    using Vector = Eigen::Matrix<double, parts, 1>;
    using Matrix = Eigen::Matrix<double, parts, parts>;

    Vector mean = Vector::Zero();
    Matrix covariance = Matrix::Zero();

    void predict(const Vector& kept, const Vector& innovation) {
        mean = mean.cwiseProduct(kept);
        covariance = covariance.cwiseProduct(kept * kept.transpose());
        covariance.diagonal() += innovation;
    }

    // ln of the density of the measurement before it was made.
    double update(double measured, double white_variance) {
        const Vector with_sum = covariance.rowwise().sum();
        const double variance = with_sum.sum() + white_variance;
        const double surprise = measured - mean.sum();
        mean += with_sum * (surprise / variance);
        covariance.noalias() -= with_sum * (with_sum.transpose() / variance);
        return -0.5 * (std::log(2.0 * pi * variance) + surprise * surprise / variance);
    }
};

template <int parts>
struct Parts {
    Eigen::Matrix<double, parts, 1> kept;
    Eigen::Matrix<double, parts, 1> innovation;
    Eigen::Matrix<double, parts, 1> start;
};

Parts<static_cast<int>(resolution::drift_parts)> parts_of(const DriftStates& noise) {
    Parts<static_cast<int>(resolution::drift_parts)> out;
    for (std::size_t i = 0; i < resolution::drift_parts; ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        out.kept[at] = noise.kept[i];
        out.innovation[at] = noise.innovation[i];
        out.start[at] = noise.start[i];
    }
    return out;
}

constexpr int drift_size = static_cast<int>(resolution::drift_parts);
using Level = Filter<drift_size>;

// One way to have come to a level, with how likely it is beside the others.
struct Way {
    Level level;
    double weight = 0.0;
};

// Of two ways to the same level one: with their common mean and covariance.
Way merged(const Way& a, const Way& b) {
    Way out;
    out.weight = a.weight + b.weight;
    const double share = a.weight / out.weight;
    out.level.mean = share * a.level.mean + (1.0 - share) * b.level.mean;
    const Level::Vector apart = b.level.mean - a.level.mean;
    out.level.covariance = share * a.level.covariance + (1.0 - share) * b.level.covariance;
    out.level.covariance.noalias() += (share * (1.0 - share) * apart) * apart.transpose();
    return out;
}

}  // namespace

double telegraph_log_likelihood(std::span<const double> averages, double step_s, const DriftStates& noise,
                                const Telegraph& telegraph) {
    const Parts<drift_size> drift = parts_of(noise);
    const double share = telegraph.high_share();
    const double forgotten = -std::expm1(-step_s / telegraph.correlation_s());
    const double leave_high = (1.0 - share) * forgotten;
    const double leave_low = share * forgotten;
    // About the mean of both. A change within an average puts it anywhere between them.
    const double high_level = telegraph.distance * (1.0 - share);
    const double low_level = -telegraph.distance * share;
    const double middle = 0.5 * (high_level + low_level);
    const double between_variance = telegraph.distance * telegraph.distance / 12.0;

    Way low;
    low.level.covariance.diagonal() = drift.start;
    low.weight = 1.0 - share;
    Way high = low;
    high.weight = share;
    double sum = 0.0;
    for (std::size_t i = 0; i < averages.size(); ++i) {
        if (i > 0) {
            low.level.predict(drift.kept, drift.innovation);
            high.level.predict(drift.kept, drift.innovation);
        }
        const double left_high = i > 0 ? leave_high : 0.0;
        const double left_low = i > 0 ? leave_low : 0.0;
        Way stayed_low{low.level, low.weight * (1.0 - left_low)};
        Way stayed_high{high.level, high.weight * (1.0 - left_high)};
        Way fell{high.level, high.weight * left_high};
        Way rose{low.level, low.weight * left_low};
        const double white = noise.white_variance;
        const std::array<double, 4> log_density = {
            stayed_low.level.update(averages[i] - low_level, white),
            stayed_high.level.update(averages[i] - high_level, white),
            fell.level.update(averages[i] - middle, white + between_variance),
            rose.level.update(averages[i] - middle, white + between_variance)};
        const double most = *std::ranges::max_element(log_density);
        stayed_low.weight *= std::exp(log_density[0] - most);
        stayed_high.weight *= std::exp(log_density[1] - most);
        fell.weight *= std::exp(log_density[2] - most);
        rose.weight *= std::exp(log_density[3] - most);
        // Neither level is ever ruled out: what is left of it would not be a number.
        stayed_low.weight += 1e-12 * fell.weight + 1e-100;
        stayed_high.weight += 1e-12 * rose.weight + 1e-100;
        low = merged(stayed_low, fell);
        high = merged(stayed_high, rose);
        const double all = low.weight + high.weight;
        sum += most + std::log(all);
        low.weight /= all;
        high.weight /= all;
    }
    return sum;
}

double gauss_markov_log_likelihood(std::span<const double> averages, double step_s, const DriftStates& noise,
                                   const Telegraph& telegraph) {
    // Beside the drift: the noise's value at the end of a step, which is not measured, and its mean over it.
    constexpr int value = drift_size;
    constexpr int mean = drift_size + 1;
    constexpr int size = drift_size + 2;
    using Vector = Eigen::Matrix<double, size, 1>;
    using Square = Eigen::Matrix<double, size, size>;
    const Parts<drift_size> drift = parts_of(noise);
    const double variance = telegraph.variance();
    const double steps = step_s / telegraph.correlation_s();
    const double lost = -std::expm1(-steps);
    const double mean_of_value = lost / steps;
    const double mean_variance = variance * 2.0 / steps * (1.0 - mean_of_value);

    Square innovation = Square::Zero();
    innovation.diagonal().head<drift_size>() = drift.innovation;
    innovation(value, value) = variance * lost * (2.0 - lost);
    innovation(mean, mean) = mean_variance - variance * mean_of_value * mean_of_value;
    innovation(value, mean) = innovation(mean, value) = variance * mean_of_value * lost;
    Vector measured = Vector::Ones();
    measured[value] = 0.0;
    // Of the old value both new ones are made; the drift's parts keep to themselves.
    Vector kept = Vector::Zero();
    kept.head<drift_size>() = drift.kept;
    kept[value] = 1.0 - lost;

    Vector state = Vector::Zero();
    Square covariance = Square::Zero();
    covariance.diagonal().head<drift_size>() = drift.start;
    covariance(value, value) = variance;
    covariance(mean, mean) = mean_variance;
    covariance(value, mean) = covariance(mean, value) = variance * mean_of_value;
    double sum = 0.0;
    for (std::size_t i = 0; i < averages.size(); ++i) {
        if (i > 0) {
            const double old_value = state[value];
            const Vector with_value = covariance.col(value);
            state = state.cwiseProduct(kept);
            state[mean] = mean_of_value * old_value;
            covariance = covariance.cwiseProduct(kept * kept.transpose());
            const Vector with_mean = mean_of_value * with_value.cwiseProduct(kept);
            covariance.col(mean) = with_mean;
            covariance.row(mean) = with_mean.transpose();
            covariance(mean, mean) = mean_of_value * mean_of_value * with_value[value];
            covariance += innovation;
        }
        const Vector with_measured = covariance * measured;
        const double expected_variance = with_measured.dot(measured) + noise.white_variance;
        const double surprise = averages[i] - state.dot(measured);
        state += with_measured * (surprise / expected_variance);
        covariance.noalias() -= with_measured * (with_measured.transpose() / expected_variance);
        sum -= 0.5 * (std::log(2.0 * pi * expected_variance) + surprise * surprise / expected_variance);
    }
    return sum;
}

}  // namespace gyrolog
