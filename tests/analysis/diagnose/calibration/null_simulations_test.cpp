#include "analysis/diagnose/calibration/null_simulations.hpp"

#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/diagnose/calibration/replicates.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr RandomPurpose simulated_for[] = {
    RandomPurpose::null_simulations,         RandomPurpose::null_bias_simulations,
    RandomPurpose::simulations_after,        RandomPurpose::simulations_in_doubt,
    RandomPurpose::measured_gap_simulations, RandomPurpose::bootstrap_simulations};

// Whoever repeats a diagnosis with the next seed wants other simulations, all of them.
TEST(Replicates, OfNeighbouringSeedsAndOtherPurposesAreOthers) {
    std::set<std::uint64_t> drawn;
    std::size_t count = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        for (const RandomPurpose purpose : simulated_for) {
            std::vector<std::uint64_t> seeds(50);
            ASSERT_TRUE(for_each_replicate({seeds.size(), seed, purpose, 1, {}},
                                           [&](std::size_t i, std::uint64_t own) { seeds[i] = own; }));
            drawn.insert(seeds.begin(), seeds.end());
            count += seeds.size();
        }
    }
    EXPECT_EQ(drawn.size(), count);
}

TEST(NullSimulations, AreOthersForAnotherPurposeAndTheSameForTheSame) {
    const auto recording = recorded(calibrated_sensor(), 2048, 3);
    const auto prediction = prediction_of(recording, calibrated_sensor());
    const auto first_number = [&](RandomPurpose purpose) {
        NullSimulationOptions options;
        options.simulations = 1;
        options.purpose = purpose;
        options.threads = 1;
        return simulate_null(prediction, nullptr, options)->curves.at(0).at(0).value.at(0);
    };
    const double before = first_number(RandomPurpose::null_simulations);
    EXPECT_EQ(first_number(RandomPurpose::null_simulations), before);
    EXPECT_NE(first_number(RandomPurpose::simulations_after), before);
}

}  // namespace
}  // namespace gyrolog
