#include "analysis/diagnose/likelihood/whittle.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

SpectralBins two_bins() {
    SpectralBins bins(2);
    bins[0].number = 1.0;
    bins[1].number = 10.0;
    return bins;
}

TEST(Whittle, IsTheSumOverAllCoefficients) {
    const std::vector<double> power = {3.0, 0.5};
    const std::vector<double> density = {2.0, 0.25};
    const double expected = -0.5 * (std::log(2.0) + 1.5) - 5.0 * (std::log(0.25) + 2.0);
    EXPECT_NEAR(whittle_log_likelihood_nats(two_bins(), power, density), expected, 1e-12);
}

TEST(Whittle, IsLargestWhereTheDensityIsThePower) {
    const std::vector<double> power = {3.0, 0.5};
    const double best = whittle_log_likelihood_nats(two_bins(), power, power);
    for (const double factor : {0.5, 0.9, 1.1, 2.0}) {
        const std::vector<double> off = {factor * power[0], factor * power[1]};
        // Eleven coefficients, each -1/2 (ln f + 1/f - 1).
        const double lost = 5.5 * (std::log(factor) + 1.0 / factor - 1.0);
        EXPECT_NEAR(best - whittle_log_likelihood_nats(two_bins(), power, off), lost, 1e-12) << factor;
    }
}

}  // namespace
}  // namespace gyrolog
