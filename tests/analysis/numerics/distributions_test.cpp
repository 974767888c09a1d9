#include "analysis/numerics/distributions.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// M. Abramowitz and I. A. Stegun (ed.), Handbook of Mathematical Functions, National Bureau of Standards
// 1964, and the tables of the NIST/SEMATECH e-Handbook of Statistical Methods, section 1.3.6.7: every printed
// digit.
constexpr double half_a_thousandth = 0.5e-3 * (1.0 + 1e-9);
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST(Distributions, NormalQuantilesAreThePublishedOnes) {
    EXPECT_EQ(normal_quantile(0.5), 0.0);
    EXPECT_NEAR(normal_quantile(0.975), 1.95996398, 1e-8);  // Abramowitz and Stegun, table 26.5
    EXPECT_NEAR(normal_quantile(0.95), 1.64485363, 1e-8);
    EXPECT_NEAR(normal_quantile(0.995), 2.57582930, 1e-8);
    EXPECT_NEAR(normal_upper_quantile(0.001), 3.09023231, 1e-8);
    EXPECT_NEAR(normal_upper_quantile(1e-6), 4.75342431, 1e-8);
    EXPECT_NEAR(normal_quantile(0.025), -1.95996398, 1e-8);
}

TEST(Distributions, UpperQuantilesReachWhereOneLessTheTailIsOne) {
    // erfc(z / sqrt 2) / 2 is the tail.
    for (const double tail : {1e-20, 1e-100, 1e-280}) {
        const double z = normal_upper_quantile(tail);
        EXPECT_NEAR(0.5 * std::erfc(z / std::sqrt(2.0)) / tail, 1.0, 1e-11) << tail;
    }
}

TEST(Distributions, ChiSquaredQuantilesAreThePublishedOnes) {
    // e-Handbook, section 1.3.6.7.4.
    EXPECT_NEAR(chi_squared_upper_quantile(1.0, 0.05), 3.841, half_a_thousandth);
    EXPECT_NEAR(chi_squared_upper_quantile(10.0, 0.05), 18.307, half_a_thousandth);
    EXPECT_NEAR(chi_squared_upper_quantile(30.0, 0.025), 46.979, half_a_thousandth);
    EXPECT_NEAR(chi_squared_upper_quantile(100.0, 0.001), 149.449, half_a_thousandth);
    EXPECT_NEAR(chi_squared_quantile(10.0, 0.05), 3.940, half_a_thousandth);
    EXPECT_NEAR(chi_squared_quantile(30.0, 0.025), 16.791, half_a_thousandth);
    // Of two degrees of freedom it is an exponential one.
    EXPECT_NEAR(chi_squared_quantile(2.0, 0.3), -2.0 * std::log(0.7), 1e-13);
}

TEST(Distributions, StudentsQuantilesAreThePublishedOnes) {
    // e-Handbook, section 1.3.6.7.2.
    EXPECT_NEAR(students_t_upper_quantile(1.0, 0.025), 12.706, half_a_thousandth);
    EXPECT_NEAR(students_t_upper_quantile(5.0, 0.05), 2.015, half_a_thousandth);
    EXPECT_NEAR(students_t_upper_quantile(10.0, 0.025), 2.228, half_a_thousandth);
    EXPECT_NEAR(students_t_upper_quantile(30.0, 0.005), 2.750, half_a_thousandth);
    EXPECT_NEAR(students_t_upper_quantile(1e9, 0.025), 1.959964, 1e-6);
}

TEST(Distributions, StudentsTailIsTheOneThatItsQuantileHas) {
    for (const double degrees : {1.0, 5.5, 126.0}) {
        for (const double tail : {0.9, 0.3, 1e-3, 1e-9}) {
            const double x = students_t_upper_quantile(degrees, tail);
            EXPECT_NEAR(students_t_upper_tail(degrees, x) / tail, 1.0, 1e-9) << degrees << ' ' << tail;
        }
    }
    EXPECT_EQ(students_t_upper_tail(3.0, 0.0), 0.5);
}

TEST(Distributions, GammaQuantilesAreThoseOfChiSquare) {
    // Chi-square of d degrees of freedom is gamma of shape d / 2 and scale 2: the table above.
    EXPECT_NEAR(gamma_upper_quantile(5.0, 2.0, 0.05), 18.307, half_a_thousandth);
    EXPECT_NEAR(gamma_quantile(15.0, 2.0, 0.025), 16.791, half_a_thousandth);
    EXPECT_NEAR(gamma_quantile(1.0, 3.0, 0.5), 3.0 * std::log(2.0), 1e-13);
}

TEST(Distributions, GammaTailsAreTheClosedForms) {
    EXPECT_NEAR(gamma_upper_tail(1.0, 3.0), std::exp(-3.0), 1e-15);             // DLMF 8.4.5
    EXPECT_NEAR(gamma_upper_tail(0.5, 2.0), std::erfc(std::sqrt(2.0)), 1e-15);  // DLMF 8.4.6
    EXPECT_NEAR(gamma_upper_tail(3.0, 2.0), 5.0 * std::exp(-2.0), 1e-15);       // DLMF 8.4.10
    EXPECT_EQ(gamma_upper_tail(2.0, 0.0), 1.0);
    EXPECT_EQ(gamma_upper_tail(1.0, 1e4), 0.0);
}

TEST(Distributions, WhatIsNoChanceOrNoParameterIsAnError) {
    EXPECT_THROW(normal_quantile(-0.1), std::domain_error);
    EXPECT_THROW(normal_quantile(1.1), std::domain_error);
    EXPECT_THROW(normal_quantile(not_a_number), std::domain_error);
    EXPECT_THROW(normal_quantile(1.0), std::overflow_error);
    EXPECT_THROW(normal_upper_quantile(0.0), std::overflow_error);
    EXPECT_THROW(chi_squared_quantile(0.0, 0.5), std::domain_error);
    EXPECT_THROW(chi_squared_quantile(2.0, 1.0), std::overflow_error);
    EXPECT_THROW(chi_squared_upper_quantile(2.0, 2.0), std::domain_error);
    EXPECT_THROW(students_t_upper_quantile(-1.0, 0.1), std::domain_error);
    EXPECT_THROW(students_t_upper_quantile(3.0, not_a_number), std::domain_error);
    EXPECT_THROW(gamma_quantile(2.0, -1.0, 0.5), std::domain_error);
    EXPECT_THROW(gamma_upper_quantile(not_a_number, 1.0, 0.5), std::domain_error);
    EXPECT_THROW(gamma_upper_tail(0.0, 1.0), std::domain_error);
    EXPECT_THROW(gamma_upper_tail(1.0, -1.0), std::domain_error);
}

}  // namespace
}  // namespace gyrolog
