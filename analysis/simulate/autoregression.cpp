#include "analysis/simulate/autoregression.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace gyrolog {

namespace {

// Of the variance: a smaller error of the prediction is that of the arithmetic.
constexpr double rounding_error = 1e-12;

}  // namespace

Autoregression::Autoregression(std::span<const double> covariances)
    : variance_(covariances.front()), predictors_(1), error_sd_{std::sqrt(covariances.front())} {
    double error = covariances.front();
    for (std::size_t n = 1; n < covariances.size(); ++n) {
        const std::vector<double>& before = predictors_.back();
        double unexplained = covariances[n];
        for (std::size_t j = 1; j < n; ++j) { unexplained -= before[j - 1] * covariances[n - j]; }
        const double reflection = unexplained / error;
        const double next_error = error * (1.0 - reflection * reflection);
        if (!(next_error > rounding_error * variance_)) { break; }
        std::vector<double> next(n);
        for (std::size_t j = 1; j < n; ++j) { next[j - 1] = before[j - 1] - reflection * before[n - j - 1]; }
        next[n - 1] = reflection;
        error = next_error;
        predictors_.push_back(std::move(next));
        error_sd_.push_back(std::sqrt(error));
    }
}

double Autoregression::density(double turns) const {
    // Horner's rule in the delay.
    const std::complex<double> delay = std::polar(1.0, -2.0 * std::numbers::pi * turns);
    const std::vector<double>& a = predictors_.back();
    std::complex<double> sum = 0.0;
    for (std::size_t j = a.size(); j-- > 0;) { sum = (sum + a[j]) * delay; }
    return error_sd_.back() * error_sd_.back() / std::norm(1.0 - sum);
}

AutoregressiveFilter::AutoregressiveFilter(std::shared_ptr<const Autoregression> process)
    : process_(std::move(process)), past_(2 * process_->order(), 0.0) {}

double AutoregressiveFilter::prediction(std::size_t n) const {
    const std::span<const double> a = process_->predictor(n);
    double sum = 0.0;
    for (std::size_t j = 0; j < n; ++j) { sum += a[j] * past_[first_ + j]; }
    return sum;
}

void AutoregressiveFilter::apply(std::span<double> white) {
    const std::size_t order = process_->order();
    for (double& sample : white) {
        const std::size_t n = std::min(seen_, order);
        sample = prediction(n) + process_->error_sd(n) * sample;
        if (seen_ < order) { ++seen_; }
        if (order == 0) { continue; }
        first_ = first_ == 0 ? order - 1 : first_ - 1;
        past_[first_] = past_[first_ + order] = sample;
    }
}

}  // namespace gyrolog
