#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/flicker_noise.hpp"
#include "analysis/simulate/sensor_simulator.hpp"
#include "tests/analysis/simulate/periodogram.hpp"

namespace gyrolog {
namespace {

// Three axes with the same noise, without converter.
SensorModel noise_only(const NoiseCoefficients& noise) {
    SensorModel model;
    model.saturation_rad_s = 1e9;
    for (AxisModel& axis : model.axes) { axis.noise = noise; }
    return model;
}

std::array<std::vector<double>, 3> simulate(const SensorModel& model, double rate_hz, std::uint64_t seed,
                                            std::size_t samples) {
    std::array<std::vector<double>, 3> axes;
    SensorSimulator simulator(model, rate_hz, seed);
    for (std::size_t done = 0; done < samples; done += block_samples) {
        const SampleBlock& block = simulator.next_block();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            axes[axis].insert(axes[axis].end(), block.rate_rad_s[axis].begin(), block.rate_rad_s[axis].end());
        }
    }
    return axes;
}

// The spectrum over whole records: its lowest frequency is one over the record's duration.
SpectrumAverage spectrum_of(const SensorModel& model, double rate_hz, std::size_t length, unsigned seeds) {
    SpectrumAverage spectrum(length);
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        for (const auto& axis : simulate(model, rate_hz, seed, length)) { spectrum.add(axis); }
    }
    return spectrum;
}

class NoiseAtRate : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Rates, NoiseAtRate, testing::Values(10.0, 100.0, 1000.0, 8000.0));

TEST_P(NoiseAtRate, FlickerHasItsSpectrumInEveryOctaveFromOneOverTheDurationToNyquist) {
    const double rate_hz = GetParam();
    NoiseCoefficients noise;
    noise.B_rad_per_s = 0.3;
    const SpectrumAverage spectrum = spectrum_of(noise_only(noise), rate_hz, 1U << 15U, 50);
    const auto octaves =
        octave_ratios(spectrum, [&](double nu) { return noise.psd(nu * rate_hz) * rate_hz; });
    ASSERT_EQ(octaves.size(), 13U);
    for (const OctaveRatio& octave : octaves) {
        EXPECT_NEAR(octave.ratio, 1.0, 0.03 + 4.0 * octave.sd)
            << "from " << octave.from_nu * rate_hz << " Hz";
    }
}

TEST_P(NoiseAtRate, WhiteNoiseHasItsDensityInEveryOctave) {
    const double rate_hz = GetParam();
    NoiseCoefficients noise;
    noise.N_rad_per_sqrt_s = 0.02;
    const SpectrumAverage spectrum = spectrum_of(noise_only(noise), rate_hz, 1U << 13U, 30);
    for (const OctaveRatio& octave :
         octave_ratios(spectrum, [&](double nu) { return noise.psd(nu * rate_hz) * rate_hz; })) {
        EXPECT_NEAR(octave.ratio, 1.0, 4.0 * octave.sd) << "from " << octave.from_nu * rate_hz << " Hz";
    }
}

TEST_P(NoiseAtRate, RateRandomWalkHasItsSpectrumBelowTheFoldingOfItsAliases) {
    const double rate_hz = GetParam();
    NoiseCoefficients noise;
    noise.K_rad_per_s_sqrt_s = 0.05;
    const SpectrumAverage spectrum = spectrum_of(noise_only(noise), rate_hz, 1U << 13U, 30);
    for (const OctaveRatio& octave :
         octave_ratios(spectrum, [&](double nu) { return noise.psd(nu * rate_hz) * rate_hz; })) {
        if (octave.from_nu > 0.05) { continue; }
        // Sampling folds the walk's own spectrum: (pi nu / sin(pi nu))^2, 3.4 % at a tenth of the rate. Two
        // bins up from zero the window still leaks from the steep slope below.
        EXPECT_NEAR(octave.ratio, 1.0, 0.035 + 4.0 * octave.sd + 0.3 * (octave.from_nu < 0.0004))
            << "from " << octave.from_nu * rate_hz << " Hz";
    }
}

TEST(FlickerNoise, TheConstructionStaysWithinItsStatedErrorOverThirtyOctaves) {
    constexpr unsigned processes = FlickerNoise::default_processes;
    const double slowest = FlickerNoise::slowest_frequency(processes);
    EXPECT_LT(slowest, 5e-11);
    for (double nu = slowest; nu < 0.49; nu *= 1.003) {
        const double wanted = 1.0 / (2.0 * pi * nu);
        const double stated_error = nu < 1e-3 ? 0.005 : 0.037;
        ASSERT_NEAR(FlickerNoise::expected_psd(nu, processes) / wanted, 1.0, stated_error) << nu;
    }
}

TEST(FlickerNoise, HasItsFullVarianceFromTheFirstSample) {
    // The slow levels come with their stationary spread: 17 levels of B^2 ln(4) / pi each, but for the
    // fastest.
    constexpr unsigned seeds = 4000;
    constexpr std::size_t later = 4096;
    double first = 0.0;
    double last = 0.0;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        std::vector<RandomStream> streams;
        for (std::uint32_t level = 0; level < 6; ++level) { streams.emplace_back(seed, level); }
        FlickerNoise noise(1.0, streams);
        std::vector<double> out(later);
        noise.add_next(out);
        first += out.front() * out.front() / seeds;
        last += out.back() * out.back() / seeds;
    }
    EXPECT_NEAR(first / last, 1.0, 4.0 * std::sqrt(2.0 * 2.0 / seeds));
    EXPECT_GT(first, 1.0);
}

TEST(FlickerNoise, DoesNotDependOnThePiecesItIsAskedFor) {
    const auto fresh = [] {
        std::vector<RandomStream> streams;
        for (std::uint32_t level = 0; level < FlickerNoise::default_processes; ++level) {
            streams.emplace_back(21, level);
        }
        return FlickerNoise(1.0, streams);
    };
    std::vector<double> whole(20'000);
    fresh().add_next(whole);
    for (const std::size_t piece : {1U, 2U, 3U, 5U, 64U, 1023U, 1025U, 7000U}) {
        std::vector<double> pieces(whole.size());
        FlickerNoise noise = fresh();
        for (std::size_t at = 0; at < pieces.size(); at += piece) {
            noise.add_next(std::span(pieces).subspan(at, std::min(piece, pieces.size() - at)));
        }
        EXPECT_EQ(pieces, whole) << "pieces of " << piece;
    }
}

// Mean square of the differences of neighbouring averages over m samples, by its definition: the test's own.
struct AllanEstimate {
    double sum = 0.0;
    double count = 0.0;

    void add(const std::vector<double>& y, std::size_t m) {
        double before = 0.0;
        for (std::size_t group = 0; (group + 1) * m <= y.size(); ++group) {
            double mean = 0.0;
            for (std::size_t i = group * m; i < (group + 1) * m; ++i) {
                mean += y[i] / static_cast<double>(m);
            }
            if (group > 0) {
                sum += 0.5 * (mean - before) * (mean - before);
                count += 1.0;
            }
            before = mean;
        }
    }
    double variance() const { return sum / count; }
    // Neighbouring differences share an average, which costs at most half of them.
    double relative_sd() const { return std::sqrt(2.0 * 2.0 / count); }
};

void expect_allan_variance(const NoiseCoefficients& noise, double rate_hz, double model_error,
                           const std::vector<std::size_t>& factors) {
    std::vector<AllanEstimate> estimates(factors.size());
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        for (const auto& axis : simulate(noise_only(noise), rate_hz, 100 + seed, 1U << 16U)) {
            for (std::size_t i = 0; i < factors.size(); ++i) { estimates[i].add(axis, factors[i]); }
        }
    }
    for (std::size_t i = 0; i < factors.size(); ++i) {
        const double tau_s = static_cast<double>(factors[i]) / rate_hz;
        EXPECT_NEAR(estimates[i].variance() / noise.allan_variance(tau_s), 1.0,
                    model_error + 4.0 * estimates[i].relative_sd())
            << "tau " << tau_s << " s";
    }
}

TEST(SimulatedNoise, HasTheAllanVarianceOfItsAngleRandomWalk) {
    NoiseCoefficients noise;
    noise.N_rad_per_sqrt_s = 0.02;
    expect_allan_variance(noise, 100.0, 0.0, {1, 2, 4, 16, 64, 256, 1024});
}

TEST(SimulatedNoise, HasTheAllanVarianceOfItsBiasInstability) {
    NoiseCoefficients noise;
    noise.B_rad_per_s = 0.3;
    // The formula is for continuous averages; the spectrum above the Nyquist frequency is missing below m
    // = 8.
    expect_allan_variance(noise, 100.0, 0.03, {8, 16, 64, 256, 1024, 4096});
}

TEST(SimulatedNoise, HasTheAllanVarianceOfItsRateRandomWalk) {
    NoiseCoefficients noise;
    noise.K_rad_per_s_sqrt_s = 0.05;
    // Averages of samples in place of continuous ones: 1 + 1/(2 m^2).
    expect_allan_variance(noise, 100.0, 0.01, {8, 16, 64, 256, 1024});
}

TEST(SimulatedNoise, HasTheAllanVarianceOfItsQuantisationNoiseAndRamp) {
    NoiseCoefficients noise;
    noise.Q_rad = 1e-3;
    expect_allan_variance(noise, 100.0, 0.0, {1, 2, 8, 64});
    noise = {};
    noise.R_rad_per_s2 = 1e-3;
    expect_allan_variance(noise, 100.0, 1e-9, {1, 8, 64, 1024});
}

}  // namespace
}  // namespace gyrolog
