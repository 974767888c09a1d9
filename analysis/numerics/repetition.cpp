#include "analysis/numerics/repetition.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <unsupported/Eigen/FFT>

namespace gyrolog {

namespace {

constexpr double repeats_least = 4.0;
constexpr double steps_least = 8.0;
constexpr std::size_t harmonics_most = 32;
constexpr std::size_t padding = 4;
// Periods whose harmonics together have less than this above the noise are not weighed.
constexpr float excess_least = 12.0F;
// Of a series: that it has the pattern, and how strong.
constexpr double series_cost_nats = 2.0;
constexpr std::array<double, 3> exponents = {0.0, 1.0, 2.0};
constexpr std::array<double, 8> strengths = {1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0};

// By frequency, 1 / (padded length) apart; of noise the mean is 1.
std::vector<float> powers(const std::vector<float>& series) {
    std::vector<float> padded(std::bit_ceil(padding * series.size()), 0.0F);
    std::ranges::copy(series, padded.begin());
    Eigen::FFT<float> fft;
    fft.SetFlag(Eigen::FFT<float>::HalfSpectrum);
    std::vector<std::complex<float>> transformed;
    fft.fwd(transformed, padded);
    std::vector<float> power(transformed.size());
    const float scale = 1.0F / static_cast<float>(series.size());
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

    // `place`: of the fundamental, in spacings of the frequencies.
    double evidence_nats(const std::vector<float>& power, double place) const {
        std::array<float, harmonics_most> at{};
        std::size_t count = 0;
        float sum = 0.0F;
        float most = 0.0F;
        // In fixed point: the numbers are small, and conversions slow.
        constexpr int fraction_bits = 32;
        const auto step = static_cast<std::uint64_t>(std::ldexp(place, fraction_bits));
        std::uint64_t next = step + (std::uint64_t{1} << (fraction_bits - 1));
        for (; count < harmonics_most; ++count, next += step) {
            const auto index = static_cast<std::size_t>(next >> fraction_bits);
            if (index >= power.size()) { break; }
            at[count] = power[index];
            sum += at[count] - 1.0F;
            most = std::max(most, sum);
        }
        if (most < excess_least) { return 0.0; }
        float best = 0.0F;
        for (const Prior& prior : priors_) {
            float nats = 0.0F;
            for (std::size_t h = 0; h < count; ++h) { nats += prior[h].weight * at[h] - prior[h].cost; }
            best = std::max(best, nats);
        }
        return std::max(0.0, static_cast<double>(best) - series_cost_nats);
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

std::vector<Repetition> repetitions(const std::vector<std::vector<float>>& series, double step_s) {
    static const Harmonics harmonics;
    std::vector<std::vector<float>> power;
    power.reserve(series.size());
    for (const std::vector<float>& one : series) { power.push_back(powers(one)); }
    const double padded = 2.0 * static_cast<double>(power.front().size() - 1);
    const double last = padded / steps_least;
    std::vector<Repetition> found;
    double place = repeats_least * padded / static_cast<double>(series.front().size());
    while (place < last) {
        const double end = std::min(2.0 * place, last);
        Repetition best;
        double best_place = place;
        double tries = 0.0;  // that differ: the highest harmonic's frequencies, without the padding
        while (place < end) {
            double nats = 0.0;
            for (const std::vector<float>& of_one : power) { nats += harmonics.evidence_nats(of_one, place); }
            if (nats > best.evidence_nats) { best.evidence_nats = nats, best_place = place; }
            // The highest harmonic is half a spacing of the frequencies off at most.
            const double harmonics_there = static_cast<double>(power.front().size()) / place;
            place += 1.0 / std::min(static_cast<double>(harmonics_most), harmonics_there);
            tries += static_cast<double>(series.front().size()) / padded;
        }
        best.evidence_nats -= std::log(std::max(tries, 1.0));
        best.period_s = step_s * padded / best_place;
        found.push_back(best);
        place = end;
    }
    return found;
}

}  // namespace gyrolog
