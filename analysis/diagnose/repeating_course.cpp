#include "analysis/diagnose/repeating_course.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdio>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "analysis/diagnose/cosine_transform.hpp"

namespace gyrolog {

namespace {

// A period shorter than some seconds is a few lines that stand alone.
constexpr double block_s = 0.1;
constexpr std::size_t blocks_least = 64;
constexpr double repetitions_least = 4.0;
constexpr std::size_t harmonics_most = 32;
constexpr std::size_t padding = 4;
// Periods whose harmonics together have less than this above the noise are not weighed.
constexpr float excess_least = 10.0F;
// Of an axis: that it has the course, and how strong.
constexpr double axis_cost_nats = 2.0;
constexpr std::array<double, 3> exponents = {0.0, 1.0, 2.0};
constexpr std::array<double, 8> strengths = {1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0};

// Under the noise that goes with the causes: what would explain the course is not in it.
std::vector<double> density_with(const Observation& without, const Observation& with, std::size_t axis) {
    const Baseline& baseline = without.baseline();
    std::vector<double> density(baseline.bins().size());
    expected_density(baseline.parts(axis), noise_uncertainty(baseline.model(), axis), with.axis(axis).noise.z,
                     density);
    return density;
}

double log_likelihood_nats(const Observation& without, const Observation& with, std::size_t axis,
                           const std::vector<double>& density) {
    const SpectralBins& bins = without.baseline().bins();
    double sum = 0.0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        sum -= 0.5 * bins[i].count() * (std::log(density[i]) + without.axis(axis).power[i] / density[i]);
    }
    for (const double z : with.axis(axis).noise.z) { sum -= 0.5 * z * z; }
    return sum;
}

std::vector<float> whitened(const Observation& without, std::size_t axis,
                            const std::vector<double>& density) {
    const Baseline& baseline = without.baseline();
    std::vector<float> values(without.axis(axis).cosines);
    for (std::size_t i = 0; i < baseline.bins().size(); ++i) {
        const auto scale = static_cast<float>(1.0 / std::sqrt(density[i] * baseline.rate_hz()));
        for (std::size_t k = baseline.bins()[i].first; k < baseline.bins()[i].end; ++k) {
            values[k] *= scale;
        }
    }
    baseline.transform()->inverse(std::span<float>(values));
    return values;
}

// Power by frequency, 1 / (padding duration) apart; of noise the mean is 1.
std::vector<float> powers(const std::vector<float>& samples, std::size_t length) {
    const std::size_t blocks = samples.size() / length;
    std::vector<float> values(std::bit_ceil(padding * blocks), 0.0F);
    for (std::size_t block = 0; block < blocks; ++block) {
        float sum = 0.0F;
        for (std::size_t i = 0; i < length; ++i) { sum += samples[block * length + i]; }
        values[block] = sum;
    }
    Eigen::FFT<float> fft;
    fft.SetFlag(Eigen::FFT<float>::HalfSpectrum);
    std::vector<std::complex<float>> transformed;
    fft.fwd(transformed, values);
    std::vector<float> power(transformed.size());
    const float scale = 1.0F / static_cast<float>(blocks * length);
    for (std::size_t i = 0; i < power.size(); ++i) { power[i] = scale * std::norm(transformed[i]); }
    return power;
}

class Harmonics {
public:
    Harmonics() {
        for (const double exponent : exponents) {
            for (const double strength : strengths) {
                Prior prior{};
                for (std::size_t h = 0; h < harmonics_most; ++h) {
                    const double v = strength * std::pow(static_cast<double>(h + 1), -exponent);
                    prior[h] = {static_cast<float>(v / (1.0 + v)), static_cast<float>(std::log1p(v))};
                }
                priors_.push_back(prior);
            }
        }
    }

    // `place`: of the fundamental, in steps of the power's frequencies.
    double evidence_nats(const std::vector<float>& power, double place) const {
        std::array<float, harmonics_most> at{};
        std::size_t count = 0;
        float sum = 0.0F;
        float most = 0.0F;
        for (; count < harmonics_most; ++count) {
            const auto index = static_cast<std::size_t>(place * static_cast<double>(count + 1) + 0.5);
            if (index >= power.size()) { break; }
            at[count] = power[index];
            sum += at[count] - 1.0F;
            most = std::max(most, sum);
        }
        if (most < excess_least) { return -axis_cost_nats; }
        float best = 0.0F;
        for (const Prior& prior : priors_) {
            float nats = 0.0F;
            for (std::size_t h = 0; h < count; ++h) { nats += prior[h].weight * at[h] - prior[h].cost; }
            best = std::max(best, nats);
        }
        return static_cast<double>(best) - axis_cost_nats;
    }

private:
    struct Weight {
        float weight;
        float cost;
    };
    using Prior = std::array<Weight, harmonics_most>;
    std::vector<Prior> priors_;
};

}  // namespace

std::optional<UnspecificFinding> find_repeating_course(const Observation& without, const Observation& with) {
    const Baseline& baseline = without.baseline();
    const auto length = std::max<std::size_t>(1, static_cast<std::size_t>(block_s * baseline.rate_hz()));
    if (baseline.length() / length < blocks_least) { return std::nullopt; }
    std::vector<std::vector<float>> power;
    double lost_nats = 0.0;
    for (const std::size_t axis : baseline.axes()) {
        const std::vector<double> density = density_with(without, with, axis);
        lost_nats +=
            without.axis(axis).noise.log_likelihood_nats - log_likelihood_nats(without, with, axis, density);
        power.push_back(powers(whitened(without, axis, density), length));
    }
    const Harmonics harmonics;
    const auto frequencies = static_cast<double>(power.front().size() - 1);
    // One step is rate / (length 2 frequencies).
    const double step_hz = baseline.rate_hz() / (2.0 * frequencies * static_cast<double>(length));
    const double first = repetitions_least / (baseline.duration_s() * step_hz);
    const double last = frequencies / 8.0;
    constexpr double step = 1.0 / static_cast<double>(harmonics_most);
    double best_nats = -1e300;
    double best_place = 0.0;
    for (double place = first; place < last; place += step) {
        double nats = 0.0;
        for (const std::vector<float>& of_axis : power) {
            nats += std::max(0.0, harmonics.evidence_nats(of_axis, place));
        }
        if (nats > best_nats) { best_nats = nats, best_place = place; }
    }
    if (!(best_nats > 0.0)) { return std::nullopt; }
    const double tries = (last - first) / (step * static_cast<double>(padding));
    std::array<char, 96> words{};
    (void)std::snprintf(words.data(), words.size(), "A course that repeats every %.4g s",
                        1.0 / (best_place * step_hz));
    return UnspecificFinding{words.data(), best_nats - std::log(tries) - lost_nats};
}

}  // namespace gyrolog
