#include "analysis/noise/noise_projection.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;

double worst_dB(const NoiseModel& model, const NoiseProjection& projection, double horizon_s) {
    double worst = 0.0;
    for (double tau_s = 1.0 / rate_hz; tau_s <= horizon_s; tau_s *= 1.01) {
        worst = std::max(worst, std::fabs(10.0 * std::log10(projection.allan_variance(tau_s) /
                                                            model.allan_variance(tau_s))));
    }
    return worst;
}

NoiseProjection project(const NoiseModel& model, ProjectedTerms terms, double horizon_s) {
    return project_noise(std::array{model}, terms, rate_hz, horizon_s);
}

const NoiseModel flicker = {.coefficients = {.N_rad_per_sqrt_s = 1e-4, .B_rad_per_s = 5e-5}};

TEST(NoiseProjection, WhatTheSimulatorHasComesBackAsItIs) {
    const NoiseModel walk = {.coefficients = {.N_rad_per_sqrt_s = 2e-4, .K_rad_per_s_sqrt_s = 3e-6}};
    const NoiseProjection as_walk = project(walk, ProjectedTerms::white_walk, 3600.0);
    EXPECT_LT(as_walk.worst_dB, 1e-9);
    EXPECT_EQ(as_walk.N_rad_per_sqrt_s, 2e-4);
    EXPECT_EQ(as_walk.K_rad_per_s_sqrt_s, 3e-6);

    const NoiseModel bias = {.coefficients = {.N_rad_per_sqrt_s = 2e-4}, .gauss_markov = {{1e-4, 50.0}}};
    const NoiseProjection as_bias = project(bias, ProjectedTerms::white_gauss_markov, 3600.0);
    EXPECT_LT(as_bias.worst_dB, 1e-9);
    EXPECT_EQ(as_bias.gauss_markov.sigma_rad_per_s, 1e-4);
    EXPECT_EQ(as_bias.gauss_markov.correlation_s, 50.0);
    EXPECT_NEAR(as_bias.drive_rad_per_s_sqrt_s(), 1e-4 * std::sqrt(2.0 / 50.0), 1e-6);
    // Of two axes that differ there is no such answer: the search finds the one between them.
    NoiseModel other = bias;
    other.gauss_markov.front().sigma_rad_per_s *= 1.0 + 1e-6;
    const NoiseProjection between =
        project_noise(std::array{bias, other}, ProjectedTerms::white_gauss_markov, rate_hz, 3600.0);
    EXPECT_LT(between.worst_dB, 0.01);
    EXPECT_NEAR(between.gauss_markov.sigma_rad_per_s, 1e-4, 1e-6);
    EXPECT_NEAR(between.gauss_markov.correlation_s, 50.0, 0.5);

    const NoiseModel white = {.coefficients = {.N_rad_per_sqrt_s = 2e-4}};
    for (const ProjectedTerms terms :
         {ProjectedTerms::white, ProjectedTerms::white_walk, ProjectedTerms::white_gauss_markov}) {
        const NoiseProjection found = project(white, terms, 3600.0);
        EXPECT_LT(found.worst_dB, 1e-9);
        EXPECT_EQ(found.N_rad_per_sqrt_s, 2e-4);
        // A converter's error is white noise as well.
        NoiseModel rounded = white;
        rounded.converter = {2e-4, rate_hz};
        EXPECT_LT(project(rounded, terms, 3600.0).worst_dB, 1e-9);
        EXPECT_NEAR(project(rounded, terms, 3600.0).N_rad_per_sqrt_s, std::sqrt(4e-8 + 4e-8 / 12.0 / rate_hz),
                    1e-15);
    }
}

TEST(NoiseProjection, TheStatedErrorIsTheTrueOne) {
    for (const double horizon_s : {10.0, 300.0, 3600.0}) {
        for (const ProjectedTerms terms :
             {ProjectedTerms::white, ProjectedTerms::white_walk, ProjectedTerms::white_gauss_markov}) {
            const NoiseProjection found = project(flicker, terms, horizon_s);
            EXPECT_NEAR(found.worst_dB, worst_dB(flicker, found, horizon_s), 0.05);
        }
    }
}

// Against a search over a net of coefficients that knows nothing of the method.
TEST(NoiseProjection, NoNeighbourIsBetter) {
    for (const double horizon_s : {100.0, 3600.0}) {
        const NoiseProjection found = project(flicker, ProjectedTerms::white_gauss_markov, horizon_s);
        double least_dB = std::numeric_limits<double>::infinity();
        for (double white = 0.5; white <= 1.5; white += 0.05) {
            for (double sigma = 0.25; sigma <= 4.0; sigma *= 1.1) {
                for (double correlation = 0.01; correlation <= 100.0; correlation *= 1.25) {
                    NoiseProjection other = found;
                    other.N_rad_per_sqrt_s = white * found.N_rad_per_sqrt_s;
                    other.gauss_markov = {sigma * found.gauss_markov.sigma_rad_per_s,
                                          correlation * found.gauss_markov.correlation_s};
                    least_dB = std::min(least_dB, worst_dB(flicker, other, horizon_s));
                }
            }
        }
        EXPECT_LT(found.worst_dB, least_dB + 0.01) << horizon_s;
    }
}

TEST(NoiseProjection, OneProjectionForAllAxesSplitsTheDifference) {
    NoiseModel louder = flicker;
    louder.coefficients.N_rad_per_sqrt_s *= 2.0;
    louder.coefficients.B_rad_per_s *= 2.0;
    const NoiseProjection alone = project(flicker, ProjectedTerms::white_gauss_markov, 100.0);
    const NoiseProjection both =
        project_noise(std::array{flicker, louder}, ProjectedTerms::white_gauss_markov, rate_hz, 100.0);
    EXPECT_NEAR(both.worst_dB, alone.worst_dB + 10.0 * std::log10(2.0), 0.05);
}

TEST(NoiseProjection, NoNoiseNeedsNone) {
    const NoiseProjection found = project({}, ProjectedTerms::white_gauss_markov, 100.0);
    EXPECT_EQ(found.N_rad_per_sqrt_s, 0.0);
    EXPECT_EQ(found.worst_dB, 0.0);
}

}  // namespace
}  // namespace gyrolog
