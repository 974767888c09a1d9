// The sensor's own noise over many seeds: spectrum and Allan variance in every octave, at several rates.
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/flicker_noise.hpp"
#include "tests/analysis/simulate/periodogram.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

using Record = std::vector<double>;

// Without converter, the same noise on each axis.
SensorModel noise_only(const NoiseCoefficients& noise) {
    SensorModel model = ideal_model();
    for (AxisModel& axis : model.axes) { axis.noise = noise; }
    return model;
}

// Three records a seed. Every rate has seeds of its own: noise that knows no rate would repeat itself.
template <typename Take>
void for_each_record(const SensorModel& model, double rate_hz, std::size_t samples, unsigned seeds,
                     Take take) {
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        SensorSimulator simulator(model, rate_hz, static_cast<std::uint64_t>(1000.0 * rate_hz) + seed);
        std::array<Record, 3> axes;
        for (std::size_t done = 0; done < samples; done += block_samples) {
            const SampleBlock& block = simulator.next_block();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                axes[axis].insert(axes[axis].end(), block.rate_rad_s[axis].begin(),
                                  block.rate_rad_s[axis].end());
            }
        }
        for (const Record& axis : axes) { take(axis); }
    }
}

// Two-sided, at nu cycles a sample, per (cycle/sample).
using Density = std::function<double(double)>;

double flicker_density(double nu) { return FlickerNoise::expected_psd(nu, FlickerNoise::default_processes); }

double ideal_flicker_density(double nu) { return 1.0 / (2.0 * pi * nu); }

// Of sequences: averages over m samples, from their spectrum.
double allan_variance(const Density& density, double m) {
    // Where the sine to the fourth power turns often, its mean does: above 8 / m.
    const double fine_end = std::min(0.5, 8.0 / m);
    constexpr int steps = 4000;
    const auto integral = [&](double from, double to, auto weight) {
        double sum = 0.0;
        const double step = std::log(to / from) / steps;
        for (int i = 0; i < steps; ++i) {
            const double nu = from * std::exp(step * (i + 0.5));
            sum += weight(nu) * density(nu) * 4.0 / std::pow(m * std::sin(pi * nu), 2) * nu * step;
        }
        return sum;
    };
    const double fine =
        integral(1e-4 / m, fine_end, [&](double nu) { return std::pow(std::sin(pi * m * nu), 4); });
    return fine + (fine_end < 0.5 ? integral(fine_end, 0.5, [](double) { return 0.375; }) : 0.0);
}

// Mean square of the differences of neighbouring averages over m samples, by its definition.
struct AllanEstimate {
    double sum = 0.0;
    double count = 0.0;

    void add(std::span<const double> y, std::size_t m) {
        double before = 0.0;
        for (std::size_t group = 0; (group + 1) * m <= y.size(); ++group) {
            double mean = 0.0;
            for (const double value : y.subspan(group * m, m)) { mean += value / static_cast<double>(m); }
            if (group > 0) {
                sum += 0.5 * (mean - before) * (mean - before);
                count += 1.0;
            }
            before = mean;
        }
    }
    double variance() const { return sum / count; }
    // Neighbouring differences share an average: half correlated at most, for white noise.
    double relative_sd() const { return std::sqrt(3.0 / count); }
};

// In every octave of tau from one sample to an eighth of the record. expected(m): in the model's units.
template <typename Expected>
void expect_allan_variances(const NoiseCoefficients& noise, double rate_hz, Expected expected) {
    constexpr std::size_t samples = 1U << 15U;
    std::vector<AllanEstimate> estimates;
    for (std::size_t m = 1; m <= samples / 8; m *= 2) { estimates.emplace_back(); }
    for_each_record(noise_only(noise), rate_hz, samples, 30, [&](const Record& record) {
        for (std::size_t i = 0; i < estimates.size(); ++i) { estimates[i].add(record, std::size_t{1} << i); }
    });
    for (std::size_t i = 0; i < estimates.size(); ++i) {
        const double m = std::ldexp(1.0, static_cast<int>(i));
        EXPECT_NEAR(estimates[i].variance() / expected(m), 1.0, 4.0 * estimates[i].relative_sd())
            << "tau " << m / rate_hz << " s";
    }
}

// smear: what the window and the curve of a steep spectrum add to bin k, in units of 1/k^2.
void expect_octaves(const NoiseCoefficients& noise, double rate_hz, double smear, const Density& expected) {
    SpectrumAverage spectrum(1U << 14U);
    for_each_record(noise_only(noise), rate_hz, spectrum.length(), 40,
                    [&](const Record& record) { spectrum.add(record); });
    for (const OctaveRatio& octave : octave_ratios(spectrum, expected)) {
        const double bin = octave.from_nu * static_cast<double>(spectrum.length());
        EXPECT_NEAR(octave.ratio, 1.0, smear / (bin * bin) + 4.0 * octave.sd)
            << "from " << octave.from_nu * rate_hz << " Hz";
    }
}

class NoiseAtRate : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Rates, NoiseAtRate, testing::Values(10.0, 100.0, 1000.0, 8000.0));

TEST_P(NoiseAtRate, WhiteNoiseHasItsSpectrumAndAllanVarianceInEveryOctave) {
    const double rate_hz = GetParam();
    const NoiseCoefficients noise{.N_rad_per_sqrt_s = 0.02};
    expect_octaves(noise, rate_hz, 0.0, [&](double) { return 4e-4 * rate_hz; });
    expect_allan_variances(noise, rate_hz, [&](double m) { return noise.allan_variance(m / rate_hz); });
}

TEST_P(NoiseAtRate, FlickerHasItsSpectrumAndAllanVarianceInEveryOctave) {
    const NoiseCoefficients noise{.B_rad_per_s = 0.3};
    expect_octaves(noise, GetParam(), 1.0 / 3.0, [](double nu) { return 0.09 * flicker_density(nu); });
    expect_allan_variances(noise, GetParam(),
                           [](double m) { return 0.09 * allan_variance(flicker_density, m); });
}

TEST_P(NoiseAtRate, TheRandomWalkHasItsSpectrumAndAllanVarianceInEveryOctave) {
    const double rate_hz = GetParam();
    const NoiseCoefficients noise{.K_rad_per_s_sqrt_s = 0.05};
    const double step_variance = 0.0025 / rate_hz;
    expect_octaves(noise, rate_hz, 1.5,
                   [&](double nu) { return step_variance / std::pow(2.0 * std::sin(pi * nu), 2); });
    // K^2 tau / 3 is for averages of what goes on between the samples too; of samples: 1 + 1/(2 m^2) of it.
    expect_allan_variances(noise, rate_hz,
                           [&](double m) { return step_variance * (2.0 * m * m + 1.0) / (6.0 * m); });
}

TEST_P(NoiseAtRate, QuantisationNoiseAndRampHaveTheirAllanVarianceInEveryOctave) {
    const double rate_hz = GetParam();
    const NoiseCoefficients angle{.Q_rad = 1e-3};
    expect_allan_variances(angle, rate_hz, [&](double m) { return angle.allan_variance(m / rate_hz); });
    const NoiseCoefficients ramp{.R_rad_per_s2 = 1e-3};
    expect_allan_variances(ramp, rate_hz, [&](double m) { return ramp.allan_variance(m / rate_hz); });
}

TEST(FlickerNoise, HasTheAllanVarianceOfOneOverFOverThirtyOctaves) {
    for (int octave = 0; octave <= 30; ++octave) {
        const double m = std::ldexp(1.0, octave);
        EXPECT_NEAR(allan_variance(flicker_density, m) / allan_variance(ideal_flicker_density, m), 1.0,
                    m < 64.0 ? 0.02 : 0.004)
            << "m = " << m;
        if (m >= 64.0) {
            EXPECT_NEAR(allan_variance(flicker_density, m) / (2.0 * std::log(2.0) / pi), 1.0, 0.005)
                << "m = " << m;
        }
    }
}

FlickerNoise fresh_flicker(std::uint64_t seed, std::uint32_t processes) {
    std::vector<RandomStream> streams;
    for (std::uint32_t process = 0; process < processes; ++process) { streams.emplace_back(seed, process); }
    return {1.0, streams};
}

TEST(FlickerNoise, HasItsFullVarianceFromTheFirstSample) {
    constexpr unsigned seeds = 6000;
    constexpr std::uint32_t processes = 6;  // reaches down to a thousandth of the rate
    double first = 0.0;
    double last = 0.0;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        FlickerNoise noise = fresh_flicker(seed, processes);
        Record out(4096);
        noise.add_next(out);
        first += out.front() * out.front() / seeds;
        last += out.back() * out.back() / seeds;
    }
    double variance = 0.0;
    for (double nu = 5e-6; nu < 0.5; nu += 1e-5) {
        variance += 2e-5 * FlickerNoise::expected_psd(nu, processes);
    }
    EXPECT_NEAR(first / variance, 1.0, 4.0 * std::sqrt(2.0 / seeds));
    EXPECT_NEAR(last / variance, 1.0, 4.0 * std::sqrt(2.0 / seeds));
}

TEST(FlickerNoise, AveragesThatStartWhereItsGridsMightDoAreLikeAnyOthers) {
    // A grid of 64 or 256 samples that stood at sample 0 in every realisation would take 1.5 % away.
    constexpr std::size_t m = 64;
    constexpr unsigned seeds = 3000;
    AllanEstimate aligned;
    AllanEstimate between;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        FlickerNoise noise = fresh_flicker(seed, 10);
        Record out(1U << 14U);
        noise.add_next(out);
        const std::span<const double> record(out);
        for (std::size_t at = 0; at + 4 * m <= record.size(); at += 4 * m) {
            aligned.add(record.subspan(at, 2 * m), m);
            between.add(record.subspan(at + m / 2, 2 * m), m);
        }
    }
    const double expected = allan_variance([](double nu) { return FlickerNoise::expected_psd(nu, 10); }, m);
    EXPECT_NEAR(aligned.variance() / expected, 1.0, 4.0 * std::sqrt(2.0 / aligned.count));
    EXPECT_NEAR(between.variance() / expected, 1.0, 4.0 * std::sqrt(2.0 / between.count));
}

TEST(FlickerNoise, TheAllanCurveIsTheSameWhereverTheStreamIsCut) {
    constexpr std::size_t part = 1U << 14U;
    constexpr std::size_t parts = 4;
    std::vector<std::array<AllanEstimate, parts>> estimates(11);
    for_each_record(noise_only({.B_rad_per_s = 1.0}), 100.0, parts * part, 30, [&](const Record& record) {
        for (std::size_t i = 0; i < estimates.size(); ++i) {
            for (std::size_t k = 0; k < parts; ++k) {
                estimates[i][k].add(std::span(record).subspan(k * part, part), std::size_t{1} << i);
            }
        }
    });
    for (std::size_t i = 0; i < estimates.size(); ++i) {
        for (std::size_t k = 0; k < parts; ++k) {
            EXPECT_NEAR(estimates[i][k].variance() /
                            allan_variance(flicker_density, std::ldexp(1.0, static_cast<int>(i))),
                        1.0, 4.0 * estimates[i][k].relative_sd())
                << "part " << k << ", m = " << (1U << i);
        }
    }
}

TEST(FlickerNoise, TheEndOfARecordIsAsFarFromItsBeginningAsOneOverFSays) {
    // A record made on a circle would end where it began.
    constexpr std::size_t samples = 1U << 14U;
    constexpr std::size_t m = samples / 16;
    double square = 0.0;
    double n = 0.0;
    for_each_record(noise_only({.B_rad_per_s = 1.0}), 100.0, samples, 400, [&](const Record& record) {
        double difference = 0.0;
        for (std::size_t i = 0; i < m; ++i) { difference += record[samples - m + i] - record[i]; }
        square += difference * difference / (m * m);
        n += 1.0;
    });
    // Averages over m, samples - m apart.
    double expected = 0.0;
    constexpr double step = 1.0 / 64.0 / samples;
    for (double nu = 0.5 * step; nu < 0.5; nu += step) {
        const double average = std::sin(pi * m * nu) / (m * std::sin(pi * nu));
        const double apart = 2.0 * std::sin(pi * (samples - m) * nu);
        expected += 2.0 * step * flicker_density(nu) * average * average * apart * apart;
    }
    EXPECT_NEAR(square / n / expected, 1.0, 4.0 * std::sqrt(2.0 / n));
}

TEST(RateRandomWalk, MovesAwayFromItsStartWithoutReturn) {
    constexpr double rate_hz = 100.0;
    constexpr std::size_t samples = 1U << 12U;
    double square = 0.0;
    double n = 0.0;
    for_each_record(noise_only({.K_rad_per_s_sqrt_s = 0.05}), rate_hz, samples, 400,
                    [&](const Record& record) {
                        EXPECT_EQ(record.front(), 0.0);
                        square += record.back() * record.back();
                        n += 1.0;
                    });
    const double expected = 0.0025 * (samples - 1.0) / rate_hz;
    EXPECT_NEAR(square / n / expected, 1.0, 4.0 * std::sqrt(2.0 / n));
}

}  // namespace
}  // namespace gyrolog
