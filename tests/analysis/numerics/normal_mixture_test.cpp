#include "analysis/numerics/normal_mixture.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Student's t scaled to variance 1, in closed form.
double log_student(double x, double nu) {
    const double scale = std::sqrt((nu - 2.0) / nu);
    const double t = x / scale;
    return std::lgamma(0.5 * (nu + 1.0)) - std::lgamma(0.5 * nu) - 0.5 * std::log(nu * pi) -
           0.5 * (nu + 1.0) * std::log1p(t * t / nu) - std::log(scale);
}

TEST(NormalMixture, IsStudentsDistributionInClosedForm) {
    for (const double nu : {2.5, 3.5, 6.0, 30.0, 150.0}) {
        // The rest that a mixture keeps has a hundredth of the standard deviation.
        const NormalMixture mixture(nu, 1.0 - 1e-4, 0.0);
        for (const double x : {0.0, 0.3, 1.0, 2.5, 6.0, 20.0}) {
            const double expected = log_student(x, nu);
            EXPECT_NEAR(mixture.log_density(x), expected, 2e-4 * (10.0 - expected)) << nu << " " << x;
        }
    }
}

TEST(NormalMixture, IsNormalWithoutTails) {
    const NormalMixture mixture(infinity, 0.7, 0.0);
    for (const double x : {0.0, 1.0, 5.0, 30.0}) {
        EXPECT_NEAR(mixture.log_density(x), -0.5 * x * x - 0.5 * std::log(2.0 * pi), 1e-9);
        EXPECT_NEAR(mixture.probability_below(x), 0.5 * std::erfc(-x / std::sqrt(2.0)), 1e-12);
    }
}

TEST(NormalMixture, HasVarianceOneWhateverItIsMadeOf) {
    for (const double lattice : {0.0, 0.3, 1.0}) {
        for (const double share : {0.5, 0.9}) {
            const NormalMixture mixture(6.0, share, lattice);
            const double step = 0.01;
            double sum = 0.0;
            double squares = 0.0;
            for (double x = -60.0; x < 60.0; x += step) {
                const double density = std::exp(mixture.log_density(x));
                sum += density * step;
                squares += density * x * x * step;
            }
            EXPECT_NEAR(sum, 1.0, 1e-6);
            // A narrow lattice counts as normal; of Student's t, 1e-5 of the variance lies beyond 60.
            EXPECT_NEAR(squares, 1.0, 1e-4) << lattice << " " << share;
        }
    }
}

TEST(NormalMixture, OnALatticeIsTheProbabilityOfACell) {
    // A converter with a step of one standard deviation of its input.
    const double step = std::sqrt(12.0 / 13.0);
    const double sd = step;
    const NormalMixture mixture(infinity, 12.0 / 13.0, step);
    for (int code = 0; code < 5; ++code) {
        const double x = code * step;
        const double cell = 0.5 * (std::erfc((x - 0.5 * step) / (sd * std::sqrt(2.0))) -
                                   std::erfc((x + 0.5 * step) / (sd * std::sqrt(2.0))));
        EXPECT_NEAR(std::exp(mixture.log_density(x)) * step / cell, 1.0, 2e-3) << code;
    }
}

TEST(LogDensityTable, IsTheMixtureBetweenItsPoints) {
    for (const double nu : {3.5, infinity}) {
        const NormalMixture mixture(nu, 0.97, 0.3);
        const LogDensityTable table(mixture);
        for (double x = 0.0; x < 12.0; x += 0.0371) {
            EXPECT_NEAR(table(x), mixture.log_density(x), 2e-6 * (1.0 + x * x)) << x;
            EXPECT_EQ(table(x), table(-x));
        }
    }
}

}  // namespace
}  // namespace gyrolog
