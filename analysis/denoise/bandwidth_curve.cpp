#include "analysis/denoise/bandwidth_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <span>

namespace gyrolog {
namespace {

constexpr double widest = 0.25;
constexpr double narrowest = 0.001;
constexpr int points_per_decade = 5;
constexpr std::size_t longest_answer = 40'000;

using Answer = std::vector<double>;

// To one sample of 1, of unit `unit` or of all.
Answer answer_to(const ArrayNoise& noise, const DenoiseDesign& design, std::size_t length,
                 std::optional<std::size_t> unit) {
    const RateDesign rate = design.method == DenoiseMethod::wavelet ? RateDesign{} : design.rate;
    const std::vector<double> no_offsets(noise.units.size(), 0.0);
    KalmanArray filter(noise, rate, FilterGain::steady, no_offsets);
    std::array<double, units_max> samples{};
    const std::span<const double> input = std::span(samples).first(noise.units.size());
    filter.step(input);
    for (std::size_t i = 0; i < input.size(); ++i) { samples.at(i) = !unit || *unit == i ? 1.0 : 0.0; }
    Answer answer(length);
    for (double& value : answer) {
        value = filter.step(input);
        samples.fill(0.0);
    }
    return answer;
}

Answer smoothed(const Answer& answer, std::span<const double> weights) {
    Answer result(answer.size() + weights.size() - 1, 0.0);
    for (std::size_t i = 0; i < answer.size(); ++i) {
        for (std::size_t j = 0; j < weights.size(); ++j) { result[i + j] += answer[i] * weights[j]; }
    }
    return result;
}

double product(const Answer& a, const Answer& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) { sum += a[i] * b[i]; }
    return sum;
}

double power_at(const Answer& answer, double cycles_per_sample) {
    std::complex<double> sum = 0.0;
    const std::complex<double> turn = std::polar(1.0, -2.0 * pi * cycles_per_sample);
    std::complex<double> phase = 1.0;
    for (const double value : answer) {
        sum += value * phase;
        phase *= turn;
    }
    return std::norm(sum);
}

// The lowest frequency at which the power falls to a half.
double half_power_hz(const Answer& answer, double rate_hz) {
    constexpr int steps = 400;
    double below = 0.0;
    for (int i = 1; i <= steps; ++i) {
        // Finely where answers are long.
        const double f = 0.5 * std::pow(narrowest * 0.1, 1.0 - static_cast<double>(i) / steps);
        if (power_at(answer, f) > 0.5) {
            below = f;
            continue;
        }
        double above = f;
        for (int halving = 0; halving < 20; ++halving) {
            const double middle = 0.5 * (below + above);
            (power_at(answer, middle) > 0.5 ? below : above) = middle;
        }
        return above * rate_hz;
    }
    return 0.0;
}

std::size_t answer_length(const ArrayNoise& noise, const DenoiseDesign& design) {
    if (design.method == DenoiseMethod::wavelet || design.rate.model == RateModel::free) { return 1; }
    // Forty time constants of a first-order filter with this bandwidth: a trend's answer is longer.
    const double samples = 40.0 * noise.rate_hz / (2.0 * pi * design.rate.bandwidth_hz);
    return std::min(longest_answer, static_cast<std::size_t>(samples) + 16);
}

FilterResponse response_with(const ArrayNoise& noise, const DenoiseDesign& design,
                             std::span<const double> weights, bool along_slope) {
    const std::size_t units = noise.units.size();
    const std::size_t length = answer_length(noise, design);
    const Answer filtered = answer_to(noise, design, length, std::nullopt);
    Answer whole = filtered;
    std::vector<Answer> answers(units);
    for (std::size_t i = 0; i < units; ++i) { answers[i] = answer_to(noise, design, length, i); }
    if (!weights.empty()) {
        whole = smoothed(whole, weights);
        for (Answer& answer : answers) { answer = smoothed(answer, weights); }
    }
    FilterResponse response;
    double variance = 0.0;
    double before = 0.0;
    for (std::size_t i = 0; i < units; ++i) {
        before += noise.units[i].white_variance / static_cast<double>(units);
        for (std::size_t j = 0; j < units; ++j) {
            const double together = i == j ? 1.0
                                    : noise.white_correlation.empty()
                                        ? 0.0
                                        : noise.white_correlation[i * units + j];
            variance += together * std::sqrt(noise.units[i].white_variance * noise.units[j].white_variance) *
                        product(answers[i], answers[j]);
        }
    }
    response.noise_ratio = variance / before;
    const Answer& late = along_slope ? filtered : whole;
    double sum = 0.0;
    double moment = 0.0;
    for (std::size_t i = 0; i < late.size(); ++i) {
        sum += late[i];
        moment += static_cast<double>(i) * late[i];
    }
    response.lag_s = moment / sum / noise.rate_hz;
    response.half_power_hz = half_power_hz(whole, noise.rate_hz);
    return response;
}

FilterResponse response_of(const ArrayNoise& noise, const DenoiseDesign& design,
                           std::span<const double> weights) {
    const bool along_slope = design.method == DenoiseMethod::joint && design.rate.model == RateModel::trend;
    return response_with(noise, design,
                         design.method == DenoiseMethod::kalman ? std::span<const double>() : weights,
                         along_slope);
}

DenoiseDesign as_trend(DenoiseDesign design, double share_of_bandwidth) {
    if (design.rate.model == RateModel::adaptive) {
        design.rate = {RateModel::trend, share_of_bandwidth * design.rate.bandwidth_hz};
    }
    return design;
}

}  // namespace

FilterResponse filter_response(const ArrayNoise& noise, const DenoiseDesign& design) {
    return response_of(noise, as_trend(design, adaptive_bandwidths.back()),
                       WaveletDenoiser::smoothing_weights(wavelet_options(design)));
}

FilterResponse calm_response(const ArrayNoise& noise, const DenoiseDesign& design) {
    return response_of(noise, as_trend(design, adaptive_bandwidths.front()),
                       WaveletDenoiser::smoothing_weights(wavelet_options(design)));
}

std::vector<BandwidthPoint> bandwidth_curve(const ArrayNoise& noise, const DenoiseDesign& design,
                                            RateModel model) {
    const std::vector<double> weights = WaveletDenoiser::smoothing_weights(wavelet_options(design));
    std::vector<BandwidthPoint> curve;
    const int points = static_cast<int>(std::ceil(points_per_decade * std::log10(widest / narrowest)));
    for (int i = 0; i <= points; ++i) {
        BandwidthPoint point;
        point.bandwidth_hz =
            noise.rate_hz * narrowest *
            std::pow(widest / narrowest, static_cast<double>(i) / static_cast<double>(points));
        DenoiseDesign trial = design;
        trial.rate = {model, point.bandwidth_hz};
        trial.method = DenoiseMethod::kalman;
        point.kalman = response_of(noise, trial, weights);
        trial.method = DenoiseMethod::joint;
        point.joint = response_of(noise, trial, weights);
        curve.push_back(point);
    }
    return curve;
}

}  // namespace gyrolog
