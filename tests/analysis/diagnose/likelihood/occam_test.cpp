#include "analysis/diagnose/likelihood/occam.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

Matrix symmetric(double a, double off, double b) {
    Matrix matrix(2, 2);
    matrix(0, 0) = a;
    matrix(1, 1) = b;
    matrix(0, 1) = matrix(1, 0) = off;
    return matrix;
}

TEST(OccamFactor, OfIndependentParametersIsTheirProduct) {
    const std::array ranges = {3.0, 50.0};
    const std::array sds = {0.02, 1.5};
    const Matrix information = symmetric(1.0 / (sds[0] * sds[0]), 0.0, 1.0 / (sds[1] * sds[1]));
    EXPECT_NEAR(joint_parameter_cost_nats(information, ranges),
                parameter_cost_nats(ranges[0], sds[0]) + parameter_cost_nats(ranges[1], sds[1]), 1e-9);
}

// The likelihood of two parameters that give way to each other, averaged over their ranges by a sum.
TEST(OccamFactor, OfParametersThatGiveWayToEachOtherIsTheAverageLikelihood) {
    const std::array ranges = {2.0, 2.0};
    const Matrix information = symmetric(500.0, 480.0, 500.0);
    constexpr int steps = 2000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const double a = ranges[0] * ((i + 0.5) / steps - 0.5);
            const double b = ranges[1] * ((j + 0.5) / steps - 0.5);
            sum += std::exp(-0.5 * (500.0 * a * a + 960.0 * a * b + 500.0 * b * b));
        }
    }
    const double expected = -std::log(sum / (static_cast<double>(steps) * steps));
    EXPECT_NEAR(joint_parameter_cost_nats(information, ranges), expected, 0.01);
    // Each by itself is known five times worse than with the other given.
    const double variance = 500.0 / (500.0 * 500.0 - 480.0 * 480.0);
    const double one_by_one = 2.0 * parameter_cost_nats(2.0, std::sqrt(variance));
    EXPECT_GT(expected - one_by_one, 1.0) << "the parameters hardly give way to each other";
}

TEST(OccamFactor, OfADirectionThatTheDataDoNotKnowIsHalfANat) {
    const std::array ranges = {1.0, 1.0};
    const double known = parameter_cost_nats(1.0, std::sqrt(1.0 / 2e4));
    EXPECT_NEAR(joint_parameter_cost_nats(symmetric(1e4, 1e4, 1e4), ranges), known + 0.5, 1e-6);
}

}  // namespace
}  // namespace gyrolog
