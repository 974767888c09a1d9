#include "analysis/denoise/adaptive_rate.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/denoise/rate_model.hpp"

namespace gyrolog {
namespace {

constexpr double stay = 0.998;
constexpr double leave = (1.0 - stay) / (adaptive_models - 1);
// Beside what one sample says: a rate that may change by 100 of its standard deviations a sample.
constexpr double unknown_slope_variances = 1e4;

}  // namespace

AdaptiveRate::AdaptiveRate(double bandwidth_hz, double rate_hz, double variance) {
    for (std::size_t i = 0; i < adaptive_models; ++i) {
        models_.at(i).intensity =
            variance * intensity_of({RateModel::trend, adaptive_bandwidths.at(i) * bandwidth_hz}, rate_hz);
    }
}

void AdaptiveRate::begin(double sample, double variance) {
    for (Model& model : models_) {
        model.rate = sample;
        model.slope = 0.0;
        model.p00 = variance;
        model.p01 = 0.0;
        model.p11 = unknown_slope_variances * variance;
    }
    probability_.fill(1.0 / adaptive_models);
    fresh_ = false;
    combine();
}

// What each model starts from: the others' estimates as far as they may have turned into it.
std::array<AdaptiveRate::Model, adaptive_models> AdaptiveRate::mixed(
    const std::array<double, adaptive_models>& predicted) const {
    std::array<Model, adaptive_models> start = models_;
    for (std::size_t j = 0; j < adaptive_models; ++j) {
        std::array<double, adaptive_models> weight{};
        Model& to = start.at(j);
        to = {.intensity = to.intensity};
        for (std::size_t i = 0; i < adaptive_models; ++i) {
            weight.at(i) = (i == j ? stay : leave) * probability_.at(i) / predicted.at(j);
            to.rate += weight.at(i) * models_.at(i).rate;
            to.slope += weight.at(i) * models_.at(i).slope;
        }
        for (std::size_t i = 0; i < adaptive_models; ++i) {
            const Model& from = models_.at(i);
            const double rate = from.rate - to.rate;
            const double slope = from.slope - to.slope;
            to.p00 += weight.at(i) * (from.p00 + rate * rate);
            to.p01 += weight.at(i) * (from.p01 + rate * slope);
            to.p11 += weight.at(i) * (from.p11 + slope * slope);
        }
    }
    return start;
}

double AdaptiveRate::update(Model& m, double sample, double variance) {
    m.rate += m.slope;
    m.p00 += 2.0 * m.p01 + m.p11 + 0.25 * m.intensity;
    m.p01 += m.p11 + 0.5 * m.intensity;
    m.p11 += m.intensity;
    const double spread = m.p00 + variance;
    const double error = sample - m.rate;
    const double to_rate = m.p00 / spread;
    const double to_slope = m.p01 / spread;
    m.rate += to_rate * error;
    m.slope += to_slope * error;
    m.p11 -= to_slope * m.p01;
    m.p01 -= to_rate * m.p01;
    m.p00 -= to_rate * m.p00;
    return -0.5 * (error * error / spread + std::log(spread));
}

void AdaptiveRate::combine() {
    rate_ = 0.0;
    slope_ = 0.0;
    for (std::size_t i = 0; i < adaptive_models; ++i) {
        rate_ += probability_.at(i) * models_.at(i).rate;
        slope_ += probability_.at(i) * models_.at(i).slope;
    }
    double variance = 0.0;
    for (std::size_t i = 0; i < adaptive_models; ++i) {
        const double apart = models_.at(i).slope - slope_;
        variance += probability_.at(i) * (models_.at(i).p11 + apart * apart);
    }
    slope_sd_ = std::sqrt(std::max(0.0, variance));
}

double AdaptiveRate::step(double sample, double variance) {
    if (fresh_) {
        begin(sample, variance);
        return rate_;
    }
    std::array<double, adaptive_models> predicted{};
    for (std::size_t j = 0; j < adaptive_models; ++j) {
        for (std::size_t i = 0; i < adaptive_models; ++i) {
            predicted.at(j) += (i == j ? stay : leave) * probability_.at(i);
        }
    }
    models_ = mixed(predicted);
    std::array<double, adaptive_models> likelihood{};
    for (std::size_t j = 0; j < adaptive_models; ++j) {
        likelihood.at(j) = update(models_.at(j), sample, variance);
    }
    const double largest = *std::ranges::max_element(likelihood);
    double sum = 0.0;
    for (std::size_t j = 0; j < adaptive_models; ++j) {
        probability_.at(j) = predicted.at(j) * std::exp(likelihood.at(j) - largest);
        sum += probability_.at(j);
    }
    for (double& p : probability_) { p /= sum; }
    combine();
    return rate_;
}

}  // namespace gyrolog
