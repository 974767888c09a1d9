// Regression on products summed by bin, against the coefficients themselves.
#include "analysis/diagnose/likelihood/mean_regression.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t axis = 1;

class MeanRegressionBySums : public testing::Test {
protected:
    void SetUp() override {
        SensorModel model = calibrated_sensor();
        model.ref_noise_rad_s = 0.02 * rad_per_deg;
        model.sd_abs = {{"M", 2e-4}, {"latency_s", 1e-4}};
        const auto world = world_turning([](double t_s) {
            return Vector3{std::sin(t_s), 0.5 * std::sin(1.7 * t_s), 0.3 * std::cos(0.6 * t_s)};
        });
        SensorModel sensor = model;
        sensor.M[axis][axis] += 4e-4;
        const auto recording = recorded(sensor, 6000, 5, world);
        prediction_ = prediction_of(recording, model);
        observation_ = std::make_unique<Observation>(prediction_, recording, 1);
        std::mt19937_64 random(7);
        std::normal_distribution<float> normal;
        for (std::vector<float>& response : responses_) {
            response.assign(prediction_->length(), 0.0F);
            for (std::size_t k = 1; k < response.size(); ++k) { response[k] = 0.1F * normal(random); }
        }
    }

    double coefficient(std::size_t k) const {
        return static_cast<double>(observation_->axis(axis).cosines[k]);
    }

    std::shared_ptr<const Prediction> prediction_;
    std::unique_ptr<Observation> observation_;
    std::vector<std::vector<float>> responses_{2};
};

TEST_F(MeanRegressionBySums, LeavesThePowerOfWhatIsLeft) {
    const MeanResponses responses(*prediction_, axis, responses_);
    const MeanRegression regression(*observation_, axis, responses);
    const AxisObservation& seen = observation_->axis(axis);
    const NormalEquations equations = regression.equations(seen.density);
    const std::vector<double> c{0.3, -0.7};
    const MeanRegression::Rest rest = regression.rest(equations, c);
    const std::vector<double> moved = equations.moved(c);
    const UncertainMean& uncertain = prediction_->uncertain(axis);
    ASSERT_EQ(uncertain.size(), 5U);
    for (std::size_t i = 0; i < prediction_->bins().size(); ++i) {
        const SpectralBin& bin = prediction_->bins()[i];
        double squares = 0.0;
        for (std::size_t k = bin.first; k < bin.end; ++k) {
            double left = coefficient(k) - 0.3 * static_cast<double>(responses_[0][k]) +
                          0.7 * static_cast<double>(responses_[1][k]);
            for (std::size_t u = 0; u < uncertain.size(); ++u) {
                left -= moved[u] * static_cast<double>(uncertain[u].cosines[k]);
            }
            squares += left * left;
        }
        const double power = squares / (bin.count() * prediction_->rate_hz());
        // The coefficients are rounded to floats.
        ASSERT_NEAR(rest.power[i], power, 1e-5 * power) << "bin " << i;
    }
}

// The uncertain responses, held by their prior, and those asked for are one least squares problem.
TEST_F(MeanRegressionBySums, SolvesTheSameProblemAsAllResponsesTogether) {
    const MeanResponses responses(*prediction_, axis, responses_);
    const MeanRegression regression(*observation_, axis, responses);
    const AxisObservation& seen = observation_->axis(axis);
    const NormalEquations equations = regression.equations(seen.density);
    const std::vector<double> c = equations.solution();

    const UncertainMean& uncertain = prediction_->uncertain(axis);
    const auto directions = static_cast<Eigen::Index>(uncertain.size());
    const auto length = static_cast<Eigen::Index>(prediction_->length());
    // One row a coefficient, over its standard deviation, and one a prior.
    Eigen::MatrixXd design = Eigen::MatrixXd::Zero(length + directions, 2 + directions);
    Eigen::VectorXd target = Eigen::VectorXd::Zero(length + directions);
    for (std::size_t i = 0; i < prediction_->bins().size(); ++i) {
        const double sd = std::sqrt(seen.density[i] * prediction_->rate_hz());
        for (std::size_t k = prediction_->bins()[i].first; k < prediction_->bins()[i].end; ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            target[row] = coefficient(k) / sd;
            for (std::size_t j = 0; j < 2; ++j) {
                design(row, static_cast<Eigen::Index>(j)) = static_cast<double>(responses_[j][k]) / sd;
            }
            for (std::size_t u = 0; u < uncertain.size(); ++u) {
                design(row, static_cast<Eigen::Index>(2 + u)) =
                    static_cast<double>(uncertain[u].cosines[k]) / sd;
            }
        }
    }
    for (std::size_t u = 0; u < uncertain.size(); ++u) {
        const auto row = static_cast<Eigen::Index>(u);
        design(length + row, 2 + row) = 1.0 / uncertain[u].sd;
        target[length + row] = -seen.uncertain_fit[u] / uncertain[u].sd;
    }
    const Eigen::VectorXd direct = design.colPivHouseholderQr().solve(target);
    const std::vector<double> moved = equations.moved(c);
    const auto direct_at = [&direct](std::size_t i) { return direct[static_cast<Eigen::Index>(i)]; };
    for (std::size_t j = 0; j < 2; ++j) { EXPECT_NEAR(c[j], direct_at(j), 1e-6 * std::fabs(direct_at(j))); }
    for (std::size_t u = 0; u < uncertain.size(); ++u) {
        EXPECT_NEAR(moved[u], direct_at(2 + u), 1e-4 * uncertain[u].sd);
    }
}

}  // namespace
}  // namespace gyrolog
