#include "analysis/noise/noise_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/allan/allan_deviation.hpp"
#include "tests/analysis/noise/sensor_noise.hpp"

namespace gyrolog {
namespace {

using State = FittedCoefficient::State;

const NoiseCoefficients truth{0.0, 0.01, 0.002, 1e-4, 0.0};

AllanCurve exact_curve(const NoiseCoefficients& noise) {
    AllanCurve curve;
    for (std::int64_t m = 1; m <= 1 << 20; m *= 2) {
        AllanPoint point;
        point.m = m;
        point.tau_s = static_cast<double>(m) / 100.0;
        point.deviation = std::sqrt(noise.allan_variance(point.tau_s));
        point.terms = (std::int64_t{1} << 21) - 2 * m + 1;
        point.edf = static_cast<double>(point.terms) / static_cast<double>(m);
        curve.points.push_back(point);
    }
    return curve;
}

TEST(NoiseFit, OfAnExactCurveIsItsModel) {
    const NoiseCoefficients all{1e-5, 0.01, 0.002, 1e-4, 1e-7};
    const NoiseFit fit = fit_noise(exact_curve(all));
    EXPECT_NEAR(fit.best.coefficients.Q_rad, all.Q_rad, 1e-6 * all.Q_rad);
    EXPECT_NEAR(fit.best.coefficients.N_rad_per_sqrt_s, all.N_rad_per_sqrt_s, 1e-8 * all.N_rad_per_sqrt_s);
    EXPECT_NEAR(fit.best.coefficients.B_rad_per_s, all.B_rad_per_s, 1e-6 * all.B_rad_per_s);
    EXPECT_NEAR(fit.best.coefficients.K_rad_per_s_sqrt_s, all.K_rad_per_s_sqrt_s,
                1e-4 * all.K_rad_per_s_sqrt_s);
    EXPECT_NEAR(fit.best.coefficients.R_rad_per_s2, all.R_rad_per_s2, 1e-2 * all.R_rad_per_s2);
    EXPECT_LT(fit.worst_residual_sd, 1e-4);
}

TEST(NoiseFit, FollowsTheUnitOfTheCurve) {
    AllanCurve curve = exact_curve(truth);
    const NoiseFit before = fit_noise(curve);
    for (AllanPoint& p : curve.points) { p.deviation *= 57.3; }
    const NoiseFit after = fit_noise(curve);
    for (const NoiseTerm term : {NoiseTerm::N, NoiseTerm::B, NoiseTerm::K}) {
        EXPECT_EQ(after[term].state, before[term].state);
        EXPECT_NEAR(after[term].value, 57.3 * before[term].value, 1e-6 * after[term].value);
        EXPECT_NEAR(after[term].sd, 57.3 * before[term].sd, 1e-4 * after[term].sd);
    }
}

TEST(NoiseFit, OfNothingClaimsNothing) {
    const NoiseFit fit = fit_noise({});
    EXPECT_EQ(fit.points, 0U);
    for (const NoiseTerm term : all_noise_terms) { EXPECT_EQ(fit[term].state, State::not_identifiable); }
}

TEST(NoiseFit, OfOnePointIsWhiteNoise) {
    AllanCurve curve = exact_curve(truth);
    curve.points.resize(1);
    EXPECT_GT(fit_noise(curve).best.coefficients.N_rad_per_sqrt_s, 0.0);
    EXPECT_EQ(fit_noise(curve).best.coefficients.B_rad_per_s, 0.0);
}

TEST(NoiseFit, NeverGivesANumberThatIsNone) {
    for (const NoiseCoefficients& noise :
         {truth, NoiseCoefficients{0.0, 0.01, 0.0, 0.0, 0.0}, NoiseCoefficients{0.0, 0.0, 0.0, 0.0, 1.0}}) {
        const AllanCurve curve = exact_curve(noise);
        for (std::size_t points = 1; points <= curve.points.size(); ++points) {
            AllanCurve part = curve;
            part.points.resize(points);
            const NoiseFit fit = fit_noise(part);
            for (const FittedCoefficient& c : fit.terms) {
                for (const double x : {c.value, c.sd, c.lo, c.hi, c.upper}) { EXPECT_TRUE(std::isfinite(x)); }
            }
        }
    }
}

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
