#include "analysis/diagnose/telegraph_filter.hpp"

#include <Eigen/Dense>
#include <algorithm>
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

template <int parts>
Parts<parts> parts_of(const DriftStates& noise) {
    Parts<parts> out;
    for (std::size_t i = 0; i < drift_parts; ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        out.kept[at] = noise.kept[i];
        out.innovation[at] = noise.innovation[i];
        out.start[at] = noise.start[i];
    }
    return out;
}

constexpr int drift_size = static_cast<int>(drift_parts);
using Level = Filter<drift_size>;

// What is known on arriving at a level, from either of them with probabilities `from_low` and the rest.
Level mixed(const Level& low, const Level& high, double from_low) {
    Level out;
    out.mean = from_low * low.mean + (1.0 - from_low) * high.mean;
    const Level::Vector apart = high.mean - low.mean;
    out.covariance = from_low * low.covariance + (1.0 - from_low) * high.covariance;
    out.covariance.noalias() += (from_low * (1.0 - from_low) * apart) * apart.transpose();
    return out;
}

}  // namespace

double telegraph_log_likelihood(std::span<const double> averages, double step_s, const DriftStates& noise,
                                const Telegraph& telegraph) {
    const Parts<drift_size> drift = parts_of<drift_size>(noise);
    const double share = telegraph.high_share();
    const double forgotten = -std::expm1(-step_s / telegraph.correlation_s());
    const double leave_high = (1.0 - share) * forgotten;
    const double leave_low = share * forgotten;
    // About the mean of both.
    const double high_level = telegraph.distance * (1.0 - share);
    const double low_level = -telegraph.distance * share;

    Level low;
    low.covariance.diagonal() = drift.start;
    Level high = low;
    double in_high = share;
    double sum = 0.0;
    for (std::size_t i = 0; i < averages.size(); ++i) {
        if (i > 0) {
            const double now_high = in_high * (1.0 - leave_high) + (1.0 - in_high) * leave_low;
            const double low_to_high = (1.0 - in_high) * leave_low / now_high;
            const double low_to_low = (1.0 - in_high) * (1.0 - leave_low) / (1.0 - now_high);
            const Level next_low = mixed(low, high, low_to_low);
            high = mixed(low, high, low_to_high);
            low = next_low;
            in_high = now_high;
            low.predict(drift.kept, drift.innovation);
            high.predict(drift.kept, drift.innovation);
        }
        const double if_high = high.update(averages[i] - high_level, noise.white_variance);
        const double if_low = low.update(averages[i] - low_level, noise.white_variance);
        const double most = std::max(if_high, if_low);
        const double high_weight = in_high * std::exp(if_high - most);
        const double low_weight = (1.0 - in_high) * std::exp(if_low - most);
        sum += most + std::log(high_weight + low_weight);
        // Neither is ever ruled out: ratios of what is left would not be numbers.
        in_high = std::clamp(high_weight / (high_weight + low_weight), 1e-12, 1.0 - 1e-12);
    }
    return sum;
}

double gauss_markov_log_likelihood(std::span<const double> averages, double step_s, const DriftStates& noise,
                                   const Telegraph& telegraph) {
    Parts<drift_size + 1> all = parts_of<drift_size + 1>(noise);
    const double kept = std::exp(-step_s / telegraph.correlation_s());
    all.kept[drift_size] = kept;
    all.start[drift_size] = telegraph.variance();
    all.innovation[drift_size] = telegraph.variance() * (1.0 - kept * kept);
    Filter<drift_size + 1> filter;
    filter.covariance.diagonal() = all.start;
    double sum = 0.0;
    for (std::size_t i = 0; i < averages.size(); ++i) {
        if (i > 0) { filter.predict(all.kept, all.innovation); }
        sum += filter.update(averages[i], noise.white_variance);
    }
    return sum;
}

}  // namespace gyrolog
