// Compiled twice: against the library, which takes the vector instructions that the machine has, and against
// the same source without any. The numbers below are the same for both.

#include "analysis/allan/difference_sums.hpp"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

__extension__ using Whole = unsigned __int128;

// Whole numbers 0 ... 2^16 - 1, the same on every machine (Knuth's MMIX generator).
class Numbers {
public:
    int next() {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return static_cast<int>(state_ >> 48U);
    }

private:
    std::uint64_t state_ = 1;
};

Column column_of(std::vector<std::int16_t> counts) {
    return {"gx", "rad/s", std::move(counts), 1.0, 0.0, "lsb"};
}

Column column_of(std::vector<double> values) { return {"gx", "rad/s", std::move(values), 1.0, 0.0, "rad_s"}; }

std::vector<std::int16_t> noise(std::size_t count, int amplitude) {
    Numbers numbers;
    std::vector<std::int16_t> counts(count);
    for (auto& x : counts) {
        x = static_cast<std::int16_t>(numbers.next() % (2 * amplitude + 1) - amplitude);
    }
    return counts;
}

std::vector<double> tenths(const std::vector<std::int16_t>& counts) {
    std::vector<double> values(counts.begin(), counts.end());
    for (double& value : values) { value *= 0.1; }
    return values;
}

// Half a record at one level, half at the other: the largest differences that n counts can have.
std::vector<std::int16_t> step(std::size_t count, int height) {
    std::vector<std::int16_t> counts = noise(count, 1);
    for (std::size_t i = 0; i < count; ++i) {
        counts[i] = static_cast<std::int16_t>(counts[i] + (i < count / 2 ? height : -height));
    }
    return counts;
}

// By the definition, from the counts, in 128 bits.
Whole sum_by_definition(const std::vector<std::int16_t>& x, std::size_t begin, std::size_t m) {
    Whole sum = 0;
    for (std::size_t k = begin; k + 2 * m <= x.size(); ++k) {
        std::int64_t d = 0;
        for (std::size_t i = 0; i < m; ++i) { d += x[k + m + i] - x[k + i]; }
        sum += static_cast<Whole>(static_cast<std::uint64_t>(std::abs(d))) *
               static_cast<std::uint64_t>(std::abs(d));
    }
    return sum;
}

std::vector<double> sums_of(const Column& column, double centre, const std::vector<std::int64_t>& m,
                            unsigned threads, std::size_t begin = 0) {
    std::vector<Stretch> stretches;
    stretches.push_back({PrefixSum(column, centre, 0, column.size()), begin});
    return sums_of_squared_differences(stretches, m, threads);
}

void expect_exact(const std::vector<std::int16_t>& counts, const std::vector<std::int64_t>& m) {
    for (const std::size_t begin : {0U, 1U}) {
        const std::vector<double> sums = sums_of(column_of(counts), 0.0, m, 1, begin);
        for (std::size_t f = 0; f < m.size(); ++f) {
            const Whole exact = sum_by_definition(counts, begin, static_cast<std::size_t>(m[f]));
            EXPECT_EQ(sums[f], static_cast<double>(exact)) << "m = " << m[f];
        }
    }
}

// Blocks of every length modulo the number of vector lanes, and more terms than one task has.
const std::vector<std::int64_t> some_factors = {1, 2, 3, 5, 7, 8, 63, 500, 2047, 2048, 5000, 9995, 10000};

TEST(DifferenceSums, OfNoiseAreExact) { expect_exact(noise(20001, 100), some_factors); }

TEST(DifferenceSums, OfDifferencesThatFill32BitsAreExact) {
    const auto counts = step(65535, 16383);
    ASSERT_TRUE(std::holds_alternative<std::vector<std::int32_t>>(
        PrefixSum(column_of(counts), 0.0, 0, counts.size()).values()));
    expect_exact(counts, {1, 100, 32700, 32767});
}

TEST(DifferenceSums, OfDifferencesBeyond32BitsAreExact) {
    const auto counts = step(80000, 32766);
    ASSERT_TRUE(std::holds_alternative<std::vector<std::int64_t>>(
        PrefixSum(column_of(counts), 0.0, 0, counts.size()).values()));
    expect_exact(counts, {1, 100, 39900, 40000});
}

TEST(DifferenceSums, OfStretchesAddUp) {
    const Column a = column_of(noise(5000, 40));
    const Column b = column_of(step(80000, 32766));
    const std::vector<std::int64_t> m = {1, 37, 2400};
    std::vector<Stretch> both;
    both.push_back({PrefixSum(a, 0.0, 0, a.size()), 0});
    both.push_back({PrefixSum(b, 0.0, 0, b.size()), 0});
    const std::vector<double> sums = sums_of_squared_differences(both, m, 1);
    for (std::size_t f = 0; f < m.size(); ++f) {
        const auto factor = static_cast<std::size_t>(m[f]);
        const Whole exact = sum_by_definition(std::get<std::vector<std::int16_t>>(a.data), 0, factor) +
                            sum_by_definition(std::get<std::vector<std::int16_t>>(b.data), 0, factor);
        EXPECT_EQ(sums[f], static_cast<double>(exact));
    }
}

TEST(DifferenceSums, DoNotDependOnTheNumberOfThreads) {
    const auto counts = noise(60000, 3000);
    std::vector<std::int64_t> m(1200);
    for (std::size_t f = 0; f < m.size(); ++f) { m[f] = static_cast<std::int64_t>(25 * f + 1); }
    for (const Column& column : {column_of(counts), column_of(tenths(counts))}) {
        const std::vector<double> one = sums_of(column, 0.5, m, 1);
        for (const unsigned threads : {2U, 3U, 8U}) { EXPECT_EQ(sums_of(column, 0.5, m, threads), one); }
    }
}

TEST(DifferenceSums, OfRealsAgreeWithThoseOfCounts) {
    const auto counts = noise(50000, 3000);
    const std::vector<std::int64_t> m = {1, 10, 1000, 20000};
    const auto exact = sums_of(column_of(counts), 0.0, m, 1);
    const auto rounded = sums_of(column_of(tenths(counts)), 0.0, m, 1);
    // Roundings of n additions, as a random walk: sqrt(50000) 2^-53, and ten times that to be safe.
    for (std::size_t f = 0; f < m.size(); ++f) { EXPECT_NEAR(rounded[f] / exact[f], 0.01, 0.01 * 2.5e-13); }
}

TEST(DifferenceSums, OfRealsAreTheSameBitsOnEveryMachine) {
    const auto sums = sums_of(column_of(tenths(noise(50000, 3000))), 0.0, {1, 10, 1000, 20000}, 1);
    EXPECT_EQ(sums, (std::vector<double>{0x1.629303e6b3337p+31, 0x1.bbfa020c6147cp+34, 0x1.f19f0edaca92p+40,
                                         0x1.b222bc2bed269p+40}));
}

// The sum of squares of a block in 64 bits must give way to the wide one just before it would overflow.
TEST(DifferenceSums, AreExactOnBothSidesOfTheNarrowLoopsLimit) {
    for (const int height : {1023, 1024, 1025, 2048, 4096}) {
        expect_exact(step(65536, height), {31000, 32768});
    }
}

}  // namespace
}  // namespace gyrolog
