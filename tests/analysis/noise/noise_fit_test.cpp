#include "analysis/noise/noise_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace gyrolog
