#include "analysis/simulate/random_purpose.hpp"

#include <cstdint>
#include <set>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

constexpr std::uint64_t seeds = 40;
constexpr auto purposes = static_cast<std::uint32_t>(RandomPurpose::bootstrap_simulations) + 1;
constexpr std::uint64_t numbers = 200;

// Seeds that follow each other, as people choose them.
TEST(RandomPurpose, GivesEverySeedPurposeAndNumberASeedOfItsOwn) {
    std::set<std::uint64_t> derived;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        derived.insert(seed);
        for (std::uint32_t purpose = 0; purpose < purposes; ++purpose) {
            for (std::uint64_t number = 0; number < numbers; ++number) {
                derived.insert(derived_seed(seed, static_cast<RandomPurpose>(purpose), number));
            }
        }
    }
    EXPECT_EQ(derived.size(), seeds * (1 + purposes * numbers));
}

TEST(RandomPurpose, IsTheSameOnEveryMachine) {
    EXPECT_EQ(derived_seed(1, RandomPurpose::noise_coefficients, 0), 0x6B5C693B2FE424F7U);
    EXPECT_EQ(derived_seed(1, RandomPurpose::noise_coefficients, 1), 0x49F7D7D72CA4F974U);
}

// The numbers of a stream are not its seed's own.
TEST(RandomPurpose, HasDrawsThatItsSeedDoesNotHave) {
    const RandomStream derived = derived_stream(7, RandomPurpose::stand_ins, 2);
    for (std::uint32_t stream = 0; stream < 1000; ++stream) {
        ASSERT_NE(RandomStream(7, stream).uniform(0), derived.uniform(0)) << stream;
    }
}

}  // namespace
}  // namespace gyrolog
