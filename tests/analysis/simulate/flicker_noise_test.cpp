#include "analysis/simulate/flicker_noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {
namespace {

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

}  // namespace
}  // namespace gyrolog
