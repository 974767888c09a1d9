#include "analysis/denoise/kalman_array.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "analysis/denoise/riccati.hpp"
#include "analysis/numerics/eigen_view.hpp"
#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

Signal run(KalmanArray& filter, const ArraySamples& samples) {
    Signal rate(samples.front().size());
    for (std::size_t k = 0; k < rate.size(); ++k) { rate[k] = filter.step(at(samples, k)); }
    return rate;
}

const RateDesign every_design[] = {{RateModel::free, 0.0}, {RateModel::walk, 5.0}, {RateModel::trend, 5.0}};

// White noise, drift, both correlations, no unit like another.
ArrayNoise uneven_units() {
    ArrayNoise noise;
    noise.rate_hz = 200.0;
    noise.units = {{1.0, 1e-4}, {4.0, 1e-5}, {0.25, 4e-4}};
    noise.white_correlation = {1.0, 0.3, 0.1, 0.3, 1.0, -0.2, 0.1, -0.2, 1.0};
    noise.walk_correlation = {1.0, 0.2, 0.0, 0.2, 1.0, 0.1, 0.0, 0.1, 1.0};
    return noise;
}

TEST(Riccati, OfOneStateIsTheSolutionOfItsQuadratic) {
    // P = P - P^2 / (P + R) + Q:  P^2 - Q P - Q R = 0
    for (const double Q : {1e-12, 1e-4, 1.0, 1e4}) {
        const auto one_by_one = [](double value) {
            return matrix_of(Eigen::MatrixXd::Constant(1, 1, value));
        };
        const SteadyCovariance steady =
            steady_covariance(one_by_one(1.0), one_by_one(1.0), one_by_one(Q), one_by_one(2.0));
        ASSERT_TRUE(steady.settled);
        const double exact = 0.5 * (Q + std::sqrt(Q * Q + 8.0 * Q));
        EXPECT_NEAR(steady.covariance(0, 0), exact, 1e-10 * exact) << Q;
    }
}

TEST(Riccati, LeavesNothingOfItsEquation) {
    Eigen::MatrixXd F(3, 3);
    F << 1, 1, 0, 0, 1, 0, 0, 0, 0.5;
    Eigen::MatrixXd H(2, 3);
    H << 1, 0, 1, 1, 0, -1;
    const Eigen::MatrixXd Q = Eigen::Vector3d(0.1, 0.01, 1.0).asDiagonal();
    Eigen::MatrixXd R(2, 2);
    R << 1.0, 0.3, 0.3, 2.0;
    const SteadyCovariance steady = steady_covariance(matrix_of(F), matrix_of(H), matrix_of(Q), matrix_of(R));
    ASSERT_TRUE(steady.settled);
    const auto P = view_of(steady.covariance);
    const Eigen::MatrixXd S = H * P * H.transpose() + R;
    const Eigen::MatrixXd left =
        F * P * F.transpose() - F * P * H.transpose() * S.inverse() * H * P * F.transpose() + Q - P;
    EXPECT_LT(left.norm(), 1e-11 * P.norm());
}

TEST(KalmanArray, OfOneUnitWithAFreeRateIsTheIdentity) {
    const ArrayNoise noise = equal_units(1, 0.5, 1e-3);
    const ArraySamples samples = array_samples(noise, Signal(500, 0.0), 1);
    for (const FilterGain gain : {FilterGain::varying, FilterGain::steady}) {
        KalmanArray filter(noise, {}, gain);
        EXPECT_EQ(run(filter, samples), samples.front());
    }
}

TEST(KalmanArray, OfEqualUnitsWithAFreeRateIsTheirMean) {
    const ArrayNoise noise = equal_units(8, 0.5, 1e-3);
    const ArraySamples samples = array_samples(noise, Signal(2000, 0.0), 2);
    KalmanArray filter(noise, {});
    for (std::size_t k = 0; k < 2000; ++k) {
        const Signal z = at(samples, k);
        ASSERT_NEAR(filter.step(z), mean_of(z), 1e-12) << k;
    }
    for (const double weight : filter.sample_weights()) { EXPECT_NEAR(weight, 0.125, 1e-14); }
}

// The variance that is left, worked out from the answers to single samples: no chance in it.
TEST(KalmanArray, OfEqualIndependentUnitsHasOneNthOfTheNoiseOfOneFilteredAlone) {
    for (const RateDesign& design : every_design) {
        double one_unit = 0.0;
        for (const std::size_t units : {1U, 2U, 3U, 8U, 16U}) {
            double left = 0.0;
            for (std::size_t unit = 0; unit < units; ++unit) {
                KalmanArray filter(equal_units(units, 1.0, 1e-7), design, FilterGain::steady,
                                   Signal(units, 0.0));
                filter.step(Signal(units, 0.0));
                Signal z(units, 0.0);
                z[unit] = 1.0;
                for (int k = 0; k < 2000; ++k) {
                    left += std::pow(filter.step(z), 2);
                    z[unit] = 0.0;
                }
            }
            if (units == 1) { one_unit = left; }
            EXPECT_NEAR(left * static_cast<double>(units) / one_unit, 1.0, 1e-6)
                << name_of(design.model) << ' ' << units;
        }
    }
}

TEST(KalmanArray, PassesAConstantRateAndTheMeanTurnOnBiasUnchanged) {
    const double biases[] = {0.5, -2.0, 7.0};
    for (const RateDesign& design : every_design) {
        KalmanArray filter(uneven_units(), design);
        double expected = 3.0;
        for (std::size_t i = 0; i < 3; ++i) { expected += filter.drift_weights()[i] * biases[i]; }
        double rate = 0.0;
        for (int k = 0; k < 20'000; ++k) { rate = filter.step(Signal{3.5, 1.0, 10.0}); }
        EXPECT_NEAR(rate, expected, 1e-4) << name_of(design.model);
        // With nothing but a constant to see, what is left is what the first samples' gain left: none.
        EXPECT_NEAR(filter.offset(2) - filter.offset(1), 9.0, 1e-4);
    }
}

TEST(KalmanArray, IsUnbiasedUnderNoise) {
    const ArrayNoise noise = equal_units(3, 0.5, 0.0);
    for (const RateDesign& design : every_design) {
        double sum = 0.0;
        constexpr int seeds = 40;
        constexpr std::size_t samples = 2000;
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            ArrayNoise no_walk = noise;
            for (UnitNoise& unit : no_walk.units) { unit.walk_variance = 1e-14; }
            KalmanArray filter(no_walk, design);
            sum += mean_of(run(filter, array_samples(noise, Signal(samples, 10.0), seed)));
        }
        // The mean of all samples, to four standard errors; the first few weigh more in a smoothing filter.
        const double error = 0.5 / std::sqrt(3.0 * static_cast<double>(samples * seeds));
        EXPECT_NEAR(sum / seeds, 10.0, 6.0 * error) << name_of(design.model);
    }
}

TEST(KalmanArray, SettlesAtTheSolutionOfTheRiccatiEquation) {
    for (const RateDesign& design : every_design) {
        KalmanArray varying(uneven_units(), design);
        for (int k = 0; k < 3000; ++k) { varying.step(Signal{0.0, 0.0, 0.0}); }
        EXPECT_TRUE(varying.is_settled()) << name_of(design.model);
        // One that never sees all units at once never jumps to the settled matrix by itself.
        KalmanArray stepped(uneven_units(), design);
        const std::uint8_t all[] = {1, 1, 1};
        const std::uint8_t some[] = {1, 1, 0};
        stepped.step(Signal{0.0, 0.0, 0.0}, some);
        for (int k = 0; k < 3000; ++k) { stepped.step(Signal{0.0, 0.0, 0.0}, all); }
        const std::vector<double> P = stepped.covariance();
        const std::vector<double> settled = stepped.settled_covariance();
        for (std::size_t i = 0; i < P.size(); ++i) { EXPECT_NEAR(P[i], settled[i], 1e-5) << i; }
    }
}

TEST(KalmanArray, VaryingAndSteadyGainAgreeInTheEnd) {
    const ArrayNoise noise = uneven_units();
    const ArraySamples samples = array_samples(noise, Signal(20'000, 0.0), 5);
    for (const RateDesign& design : every_design) {
        KalmanArray varying(noise, design);
        KalmanArray steady(noise, design, FilterGain::steady);
        const Signal a = run(varying, samples);
        const Signal b = run(steady, samples);
        EXPECT_NEAR(a.back(), b.back(), 1e-6) << name_of(design.model);
    }
}

// Against the textbook's filter on all N + 1 states, biases and rate, in which the common bias is seen by
// nobody: started with that direction known, it is the same filter.
TEST(KalmanArray, AgreesWithTheFilterOfAllBiasesAndTheRate) {
    const ArrayNoise noise = uneven_units();
    const RateDesign design{RateModel::walk, 5.0};
    KalmanArray filter(noise, design);
    const double w = intensity_of(design, noise.rate_hz);
    Eigen::Matrix3d R;
    Eigen::Matrix3d B;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const auto at = static_cast<std::size_t>(3 * i + j);
            const auto& a = noise.units[static_cast<std::size_t>(i)];
            const auto& b = noise.units[static_cast<std::size_t>(j)];
            R(i, j) = noise.white_correlation[at] * std::sqrt(a.white_variance * b.white_variance);
            B(i, j) = noise.walk_correlation[at] * std::sqrt(a.walk_variance * b.walk_variance);
        }
    }
    const Eigen::Vector3d ones = Eigen::Vector3d::Ones();
    Eigen::Vector3d v = B.inverse() * ones;
    v /= v.sum();
    Eigen::Matrix4d Q = Eigen::Matrix4d::Zero();
    Q.topLeftCorner(3, 3) = B;
    Q(3, 3) = w / (ones.transpose() * R.inverse() * ones)(0, 0);
    Eigen::Matrix<double, 3, 4> H;
    H << Eigen::Matrix3d::Identity(), ones;
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ones * v.transpose();
    Eigen::Matrix4d P = Eigen::Matrix4d::Zero();
    P.topLeftCorner(3, 3) = 4e6 * across * across.transpose();
    P(3, 3) = 4e6;
    Eigen::Vector4d x = Eigen::Vector4d::Zero();
    const ArraySamples samples = array_samples(noise, Signal(4000, 1.0), 6);
    for (std::size_t k = 0; k < 4000; ++k) {
        const Signal z = at(samples, k);
        const double rate = filter.step(z);
        const Eigen::Matrix3d S = H * P * H.transpose() + R;
        const Eigen::Matrix<double, 4, 3> K = P * H.transpose() * S.inverse();
        x += K * (Eigen::Vector3d(z[0], z[1], z[2]) - H * x);
        P = (Eigen::Matrix4d::Identity() - K * H) * P;
        P = 0.5 * (P + P.transpose()).eval() + Q;
        // From the first samples each keeps a trace of what it took for unknown.
        if (k > 50) { ASSERT_NEAR(rate, x[3] + v.dot(x.head(3)), 1e-3) << k; }
    }
}

TEST(KalmanArray, InnovationsAreWhiteAndAsLargeAsTheirCovarianceSays) {
    const ArrayNoise noise = uneven_units();
    constexpr std::size_t samples = 40'000;
    for (const RateDesign& design : every_design) {
        // The rate moves as the model says, so that the filter is right.
        Signal rate(samples, 0.0);
        Signal steps(samples);
        RandomStream(7, 50).normals(0, steps);
        const double sd = std::sqrt(intensity_of(design, noise.rate_hz) * 1.0 / [&] {
            std::vector<double> C(9);
            for (std::size_t i = 0; i < 9; ++i) {
                C[i] = noise.white_correlation[i] *
                       std::sqrt(noise.units[i / 3].white_variance * noise.units[i % 3].white_variance);
            }
            const std::vector<double> a = least_variance_weights(C, 3);
            double variance = 0.0;
            for (std::size_t i = 0; i < 9; ++i) { variance += a[i / 3] * a[i % 3] * C[i]; }
            return 1.0 / variance;
        }());
        double slope = 0.0;
        for (std::size_t k = 1; k < samples; ++k) {
            if (design.model == RateModel::walk) { rate[k] = rate[k - 1] + sd * steps[k]; }
            if (design.model == RateModel::trend) {
                rate[k] = rate[k - 1] + slope + 0.5 * sd * steps[k];
                slope += sd * steps[k];
            }
        }
        KalmanArray filter(noise, design);
        const ArraySamples z = array_samples(noise, rate, 8);
        ArraySamples innovations(3, Signal());
        double power = 0.0;
        for (std::size_t k = 0; k < samples; ++k) {
            filter.step(at(z, k));
            if (k < 2000) { continue; }
            const auto e = filter.innovations();
            const double common = design.model == RateModel::free ? (e[0] + e[1] + e[2]) / 3.0 : 0.0;
            for (std::size_t i = 0; i < 3; ++i) { innovations[i].push_back(e[i] - common); }
            power += filter.innovation_power();
        }
        const auto count = static_cast<double>(samples - 2000);
        const double freedom = design.model == RateModel::free ? 2.0 : 3.0;
        EXPECT_NEAR(power / count, freedom, 5.0 * std::sqrt(2.0 * freedom / count)) << name_of(design.model);
        for (const Signal& unit : innovations) {
            const double variance = variance_of(unit);
            for (const std::size_t lag : {1U, 2U, 5U, 20U, 100U}) {
                double sum = 0.0;
                for (std::size_t k = lag; k < unit.size(); ++k) { sum += unit[k] * unit[k - lag]; }
                EXPECT_NEAR(sum / count / variance, 0.0, 5.0 / std::sqrt(count))
                    << name_of(design.model) << " lag " << lag;
            }
        }
    }
}

TEST(KalmanArray, WeighsUnequalUnitsByTheirNoiseAtOnceAndByTheirDriftInTheLongRun) {
    ArrayNoise noise;
    noise.rate_hz = 100.0;
    noise.units = {{1.0, 1e-6}, {4.0, 1e-8}};
    KalmanArray filter(noise, {});
    EXPECT_NEAR(filter.sample_weights()[0], 0.8, 0.01);
    EXPECT_NEAR(filter.drift_weights()[1], 1e8 / (1e6 + 1e8), 1e-12);
    // A step of the first unit's bias is followed at first by its weight, in the end by its drift's.
    for (int k = 0; k < 200'000; ++k) { filter.step(Signal{0.0, 0.0}); }
    EXPECT_NEAR(filter.step(Signal{1.0, 0.0}), 0.8, 0.01);
    double last = 0.0;
    for (int k = 0; k < 200'000; ++k) { last = filter.step(Signal{1.0, 0.0}); }
    EXPECT_NEAR(last, 1e6 / (1e6 + 1e8), 1e-3);
}

// Drifts that oppose each other cancel: what the correlation coefficient is for.
TEST(KalmanArray, GainsByDriftsOfOppositeCorrelation) {
    double drift[2] = {};
    for (const double rho : {0.0, -0.9}) {
        ArrayNoise noise = equal_units(2, 0.1, 0.01);
        noise.walk_correlation = equal_correlation(2, rho);
        KalmanArray filter(noise, {});
        const Signal rate = run(filter, array_samples(noise, Signal(20'000, 0.0), 9));
        drift[rho < 0.0 ? 1 : 0] = variance_of(rate);
    }
    EXPECT_LT(drift[1], 0.4 * drift[0]);
}

TEST(KalmanArray, GoesOnWithoutAJumpWhenAUnitIsLeftOut) {
    const ArrayNoise noise = equal_units(3, 0.1, 1e-5);
    ArraySamples samples = array_samples(noise, Signal(4000, 2.0), 10);
    for (double& z : samples[1]) { z += 5.0; }
    for (const RateDesign& design : every_design) {
        KalmanArray filter(noise, design);
        Signal rate(4000);
        for (std::size_t k = 0; k < 4000; ++k) {
            const std::uint8_t used[] = {1, static_cast<std::uint8_t>(k < 2000 ? 1 : 0), 1};
            Signal z = at(samples, k);
            if (k >= 2000) { z[1] = 1000.0; }
            rate[k] = filter.step(z, used);
        }
        const double before = mean_of(Signal(rate.begin() + 500, rate.begin() + 2000));
        const double after = mean_of(Signal(rate.begin() + 2000, rate.end()));
        EXPECT_NEAR(after, before, 0.1 * 6.0 / std::sqrt(3.0 * 1500.0) + 0.01) << name_of(design.model);
    }
}

TEST(KalmanArray, PredictsWhereNoUnitIsLeftAndStartsAnewAfterAGap) {
    const ArrayNoise noise = equal_units(2, 0.1, 1e-5);
    KalmanArray filter(noise, {RateModel::trend, 5.0});
    for (int k = 0; k < 500; ++k) { filter.step(Signal{0.1 * k, 0.1 * k}); }
    const std::uint8_t none[] = {0, 0};
    EXPECT_NEAR(filter.step(Signal{std::nan(""), std::nan("")}, none), 50.0, 1e-3);
    filter.skip(10'000);
    EXPECT_NEAR(filter.step(Signal{-7.0, -7.0}), -7.0, 1e-3);
}

}  // namespace
}  // namespace gyrolog
