#include "analysis/numerics/cosine_transform.hpp"

#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {
namespace {

std::vector<double> by_definition(const std::vector<double>& x) {
    const auto n = static_cast<double>(x.size());
    std::vector<double> y(x.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
        double sum = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            sum += x[i] * std::cos(pi * static_cast<double>(k) * (static_cast<double>(i) + 0.5) / n);
        }
        y[k] = sum * std::sqrt((k == 0 ? 1.0 : 2.0) / n);
    }
    return y;
}

std::vector<double> noise(std::size_t length) {
    const RandomStream random(7, 1);
    std::vector<double> x(length);
    for (std::size_t i = 0; i < length; ++i) { x[i] = random.normal(i); }
    return x;
}

TEST(CosineTransform, IsItsDefinition) {
    for (const std::size_t length : {4U, 12U, 60U, 128U, 500U}) {
        std::vector<double> x = noise(length);
        const std::vector<double> expected = by_definition(x);
        CosineTransform(length).forward(x);
        for (std::size_t k = 0; k < length; ++k) {
            EXPECT_NEAR(x[k], expected[k], 1e-11) << length << ' ' << k;
        }
    }
}

TEST(CosineTransform, IsUndoneByItsInverse) {
    const std::vector<double> x = noise(90000);
    std::vector<double> y = x;
    CosineTransform transform(x.size());
    transform.forward(y);
    transform.inverse(y);
    for (std::size_t i = 0; i < x.size(); ++i) { ASSERT_NEAR(x[i], y[i], 1e-10) << i; }
}

TEST(CosineTransform, IsUndoneInSingleNumbersAsInDoubleOnes) {
    std::vector<double> y = noise(90000);
    std::vector<float> in_single(y.begin(), y.end());
    CosineTransform transform(y.size());
    transform.inverse(y);
    transform.inverse(std::span<float>(in_single));
    for (std::size_t i = 0; i < y.size(); ++i) {
        ASSERT_NEAR(static_cast<double>(in_single[i]), y[i], 5e-6) << i;
    }
}

TEST(CosineTransform, HasFastLengthsThatLoseLittle) {
    EXPECT_EQ(fast_length(4), 4U);
    EXPECT_EQ(fast_length(720000), 720000U);
    for (std::size_t most = 2048; most < 3000000; most += most / 7 + 1) {
        const std::size_t length = fast_length(most);
        EXPECT_LE(length, most);
        EXPECT_EQ(length % 4, 0U);
        EXPECT_GT(static_cast<double>(length), 0.94 * static_cast<double>(most)) << most;
    }
}

}  // namespace
}  // namespace gyrolog
