// What is true of the fits over many records: false terms, bias, coverage.

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/noise/analyze.hpp"
#include "tests/analysis/noise/over_seeds.hpp"
#include "tests/analysis/noise/sensor_noise.hpp"
#include "tests/analysis/noise/test_recording.hpp"

namespace gyrolog {
namespace {

using State = FittedCoefficient::State;

NoiseFit fit_of(std::vector<double> samples, double rate_hz) {
    return analyze(test::recording_of({std::move(samples)}, rate_hz)).axes.at(0).fit;
}

TEST(LikelihoodFit, OfWhiteNoiseForcesNoSlopeWhereThereIsNone) {
    constexpr std::size_t records = 40;
    const auto fits = test::over_seeds(records, [](std::uint64_t seed) {
        return fit_of(test::sensor_noise({0.0, 0.01, 0.0, 0.0, 0.0}, 20'000, 100.0, seed), 100.0);
    });
    int others = 0;
    for (const NoiseFit& fit : fits) {
        const FittedCoefficient& N = fit[NoiseTerm::N];
        EXPECT_EQ(N.state, State::identified);
        EXPECT_NEAR(N.value, 0.01, 4.0 * N.sd);
        for (const NoiseTerm term : {NoiseTerm::Q, NoiseTerm::B, NoiseTerm::K, NoiseTerm::R}) {
            others += fit[term].state == State::identified ? 1 : 0;
            EXPECT_GT(fit[term].upper, 0.0) << name_of(term);
        }
        others += static_cast<int>(fit.gauss_markov.size() + fit.sinusoids.size());
    }
    // Half a percent each of 40 records and four terms is 0.8.
    EXPECT_LE(others, 4);
}

TEST(LikelihoodFit, TakesARandomWalkForARampInFewRecordsOnly) {
    constexpr std::size_t records = 40;
    const auto fits = test::over_seeds(records, [](std::uint64_t seed) {
        return fit_of(test::sensor_noise({0.0, 0.001, 0.0, 1e-3, 0.0}, 20'000, 10.0, seed), 10.0);
    });
    int ramps = 0;
    for (const NoiseFit& fit : fits) { ramps += fit[NoiseTerm::R].state == State::identified ? 1 : 0; }
    EXPECT_LE(ramps, 2);
}

const NoiseCoefficients truth{0.0, 0.01, 0.002, 1e-4, 0.0};

struct Tally {
    int runs = 0;
    int identified = 0;
    int covered = 0;  // by the interval, or by the upper limit
    double sum = 0.0;
    double squares = 0.0;
    double sd = 0.0;

    void add(const FittedCoefficient& fitted, double estimate, double wanted) {
        ++runs;
        sum += estimate / wanted - 1.0;
        squares += std::pow(estimate / wanted - 1.0, 2);
        if (fitted.state == State::identified) {
            ++identified;
            sd += fitted.sd / wanted;
            covered += fitted.lo <= wanted && wanted <= fitted.hi ? 1 : 0;
        } else {
            covered += wanted <= fitted.upper ? 1 : 0;
        }
    }
    double bias() const { return sum / runs; }
    double rms() const { return std::sqrt(squares / runs); }
    double mean_sd() const { return sd / identified; }
};

// A hundred minutes at 10 Hz: N and B can be told, K hardly (its own period of e-folding is longer than the
// record).
TEST(NoiseFit, IsUnbiasedAndItsIntervalsCoverTheTruth) {
    constexpr std::size_t samples = 60000;
    Tally N;
    Tally B;
    Tally K;
    for (std::uint64_t seed = 100; seed < 124; ++seed) {
        const Column column{"gx", "rad/s", test::sensor_noise(truth, samples, 10.0, seed), 1.0, 0.0, "rad_s"};
        const NoiseFit fit = fit_noise(allan_deviation(column, {{{0, samples, 0}}}, 10.0));
        N.add(fit[NoiseTerm::N], fit.best.coefficients.N_rad_per_sqrt_s, truth.N_rad_per_sqrt_s);
        B.add(fit[NoiseTerm::B], fit.best.coefficients.B_rad_per_s, truth.B_rad_per_s);
        K.add(fit[NoiseTerm::K], fit.best.coefficients.K_rad_per_s_sqrt_s, truth.K_rad_per_s_sqrt_s);
    }
    EXPECT_EQ(N.identified, 24);
    EXPECT_EQ(B.identified, 24);
    // Three standard deviations of a mean of 24.
    EXPECT_LT(std::abs(N.bias()), 3.0 * N.rms() / std::sqrt(24.0));
    EXPECT_LT(std::abs(B.bias()), 3.0 * B.rms() / std::sqrt(24.0));
    EXPECT_LT(N.rms(), 0.008);
    EXPECT_LT(B.rms(), 0.16);
    // A standard deviation from 24 runs is known to 15 %.
    EXPECT_NEAR(N.mean_sd() / N.rms(), 1.0, 0.45);
    EXPECT_NEAR(B.mean_sd() / B.rms(), 1.0, 0.45);
    // 68.3 % of 24 is 16.4 with a standard deviation of 2.3.
    EXPECT_NEAR(N.covered, 16.4, 6.9);
    EXPECT_NEAR(B.covered, 16.4, 6.9);
    EXPECT_GE(K.covered, 10);
}

}  // namespace
}  // namespace gyrolog
