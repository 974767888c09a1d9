// What the other gyros of an array say of the motion of one of them.
#include "analysis/denoise/array_reference.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/numerics/square.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog {
namespace {

using testing::HasSubstr;

constexpr double rate_hz = 100.0;
constexpr std::size_t rows = 12'000;  // 2 min
constexpr std::size_t still_rows = 3000;
constexpr double noise_rad_per_sqrt_s = 0.005 * rad_per_deg;
constexpr double noise_rad_s = noise_rad_per_sqrt_s * 10.0;  // of a sample

using Signals = std::vector<std::vector<double>>;

// At rest, then swings about all axes at once.
Signals motion(double size_rad_s) {
    Signals signals(3, std::vector<double>(rows, 0.0));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double f_hz = 0.3 + 0.17 * static_cast<double>(axis);
        for (std::size_t row = still_rows; row < rows; ++row) {
            const double t_s = static_cast<double>(row - still_rows) / rate_hz;
            signals[axis][row] = size_rad_s * std::sin(2.0 * pi * f_hz * t_s);
        }
    }
    return signals;
}

Recording with_columns(const char* prefix, const std::string& behind, const Signals& signals,
                       Recording recording = {}) {
    recording.rate_hz = rate_hz;
    recording.segments = {{0, rows, 0}};
    for (std::size_t axis = 0; axis < signals.size(); ++axis) {
        recording.columns.push_back(
            {prefix + std::string(axis_names.at(axis)) + behind, "rad/s", signals[axis], 1.0, 0.0, "rad_s"});
    }
    return recording;
}

SensorModel quiet_gyro(double bias_dps) {
    SensorModel model;
    model.rate_hz = rate_hz;
    model.full_scale_rad_s = model.saturation_rad_s = 100.0;
    for (AxisModel& axis : model.axes) {
        axis.noise.N_rad_per_sqrt_s = noise_rad_per_sqrt_s;
        axis.bias_rad_s = bias_dps * rad_per_deg;
    }
    return model;
}

// As many gyros as there are models, in this motion.
Recording array_of(const std::vector<SensorModel>& models, const Signals& moved, std::uint64_t seed) {
    const auto world = std::make_shared<const RecordedWorld>(std::make_shared<const Recording>(
        with_columns("ref_", "", moved, with_columns("g", "", Signals(3, std::vector<double>(rows, 0.0))))));
    Recording array;
    for (std::size_t i = 0; i < models.size(); ++i) {
        SimulationRequest request;
        request.like = world;
        request.seed = 100 * seed + i;
        const Recording one = simulate_recording(models[i], request);
        Signals signals;
        for (const char* name : {"gx", "gy", "gz"}) { signals.push_back(one.find(name)->values()); }
        array = with_columns("g", std::to_string(i + 1), signals, std::move(array));
    }
    return array;
}

// The slope of a reference's error over an axis of the motion, in its standard deviations: `gyros` average
// the noise, of which the median response of three adds as much again as one has at most.
double slope_off(const Recording& recording, std::size_t of_axis, const Signals& moved, std::size_t on_axis,
                 double gyros) {
    std::vector<double> error = recording.columns.at(3 + of_axis).values();
    std::ranges::transform(error, moved[of_axis], error.begin(), std::minus{});
    const std::vector<double>& true_rate = moved[on_axis];
    const double squares = std::inner_product(true_rate.begin(), true_rate.end(), true_rate.begin(), 0.0);
    const double slope = std::inner_product(error.begin(), error.end(), true_rate.begin(), 0.0) / squares;
    return slope / (std::sqrt(1.0 / gyros + 1.0) * noise_rad_s / std::sqrt(squares));
}

void expect_true_reference(const Recording& array, const Signals& moved) {
    for (unsigned long unit = 1; unit <= 3; ++unit) {
        const UnitOfArray judged = unit_against_others(array, unit);
        ASSERT_EQ(judged.failure, "");
        EXPECT_EQ(judged.recording.reference_gyros, 2U);
        ASSERT_EQ(judged.recording.columns.size(), 6U);
        EXPECT_EQ(judged.recording.columns[0].values(), array.find("gx" + std::to_string(unit))->values());
        for (std::size_t of_axis = 0; of_axis < 3; ++of_axis) {
            for (std::size_t on_axis = 0; on_axis < 3; ++on_axis) {
                // Nine slopes of three units and some seeds: once in 500 such tests by chance.
                EXPECT_LT(std::abs(slope_off(judged.recording, of_axis, moved, on_axis, 2.0)), 4.5)
                    << "gyro " << unit << ", " << axis_names.at(of_axis) << " from "
                    << axis_names.at(on_axis);
            }
        }
    }
}

// The mean of two of which one is off by 1 % is off by 0.5 %, some 600 standard deviations.
TEST(ArrayReference, IsNotOffWhereOneGyroOfThreeIs) {
    const Signals moved = motion(1.0);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(seed);
        std::vector<SensorModel> models{quiet_gyro(0.3), quiet_gyro(-1.0), quiet_gyro(0.0)};
        models[1].effects = {{"scale_factor", {"x"}, {{"eps", 0.01}}, ""}};
        expect_true_reference(array_of(models, moved, seed), moved);
        models[1].effects = {{"misalignment", {"z"}, {{"from_x", 0.01}}, ""}};
        expect_true_reference(array_of(models, moved, seed), moved);
    }
}

// A louder one counts for less, and the noise of none looks like a response.
TEST(ArrayReference, WeighsByTheNoise) {
    const Signals moved = motion(0.02);
    std::vector<SensorModel> models(3, quiet_gyro(0.0));
    for (AxisModel& axis : models[2].axes) { axis.noise.N_rad_per_sqrt_s *= 3.0; }
    const Recording array = array_of(models, moved, 1);
    const UnitOfArray judged = unit_against_others(array, 1);
    ASSERT_EQ(judged.failure, "");
    const std::vector<double> reference = judged.recording.find("ref_y")->values();
    const double squares =
        std::inner_product(reference.begin(), reference.begin() + still_rows, reference.begin(), 0.0);
    const double expected = square(noise_rad_s) / (1.0 + 1.0 / 9.0);
    // Of n squares the relative standard deviation is sqrt(2 / n); the weights are known to some percent.
    EXPECT_NEAR(squares / still_rows / expected, 1.0, 5.0 * std::sqrt(2.0 / still_rows));
    for (unsigned long unit = 1; unit <= 3; ++unit) {
        const UnitOfArray one = unit_against_others(array, unit);
        ASSERT_EQ(one.failure, "");
        EXPECT_LT(std::abs(slope_off(one.recording, 1, moved, 1, 0.1)), 4.5) << "gyro " << unit;
    }
}

TEST(ArrayReference, OfTwoIsTheOther) {
    const Signals moved = motion(1.0);
    const Recording array = array_of({quiet_gyro(0.0), quiet_gyro(0.5)}, moved, 1);
    const UnitOfArray judged = unit_against_others(array, 1);
    ASSERT_EQ(judged.failure, "");
    EXPECT_EQ(judged.recording.reference_gyros, 1U);
    const double off = judged.recording.find("ref_x")->value(rows / 2) - array.find("gx2")->value(rows / 2);
    EXPECT_NEAR(off, -0.5 * rad_per_deg, 5.0 * noise_rad_s / std::sqrt(0.8 * still_rows));
}

TEST(ArrayReference, IsMissingWhereAGyroIsOrIsAtItsEnd) {
    const Signals moved = motion(1.0);
    Recording array = array_of(std::vector<SensorModel>(3, quiet_gyro(0.0)), moved, 1);
    const auto put = [&](const char* name, std::size_t row, double value) {
        Column& column = *std::ranges::find(array.columns, name, &Column::name);
        std::vector<double> values = column.values();
        values[row] = value;
        column = {name, "rad/s", std::move(values), 1.0, 0.0, "rad_s"};
    };
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    put("gy2", 5000, unknown);
    put("gx3", 6000, 250.0 * rad_per_deg);  // the end of a usual range
    put("gz1", 7000, unknown);
    const UnitOfArray judged = unit_against_others(array, 1);
    ASSERT_EQ(judged.failure, "");
    EXPECT_EQ(judged.recording.rows(), rows - 3);
    std::vector<std::size_t> ends;
    for (const Segment& segment : judged.recording.segments) {
        ends.push_back(static_cast<std::size_t>(segment.first_index) + segment.count);
    }
    EXPECT_EQ(ends, (std::vector<std::size_t>{5000, 6000, 7000, rows}));
    for (const char* name : {"ref_x", "ref_y", "ref_z"}) {
        EXPECT_TRUE(std::ranges::all_of(judged.recording.find(name)->values(),
                                        [](double value) { return std::isfinite(value); }));
    }
    ASSERT_EQ(judged.recording.warnings.size(), 1U);
    EXPECT_THAT(judged.recording.warnings.front(), HasSubstr("in 2 of 11999 samples: they are left out"));
    EXPECT_EQ(unit_of_array(array, 1).recording.rows(), rows - 1);
}

TEST(ArrayReference, SaysWhatIsMissing) {
    const Signals moved = motion(1.0);
    const auto failure = [](const Recording& recording, unsigned long unit) {
        return unit_against_others(recording, unit).failure;
    };
    Recording array = array_of(std::vector<SensorModel>(3, quiet_gyro(0.0)), moved, 1);
    EXPECT_THAT(failure(array, 4), HasSubstr("has no gyro 4: its gyros are 1, 2, 3"));
    EXPECT_THAT(failure(with_columns("g", "", moved), 1), HasSubstr("has no array of gyros"));
    EXPECT_THAT(failure(with_columns("g", "1", moved), 1), HasSubstr("has no gyro beside gyro 1"));
    EXPECT_THAT(failure(with_columns("ref_", "", moved, array), 1), HasSubstr("has a reference already"));
    EXPECT_THAT(failure(array_of(std::vector<SensorModel>(3, quiet_gyro(0.0)), motion(0.0), 1), 1),
                HasSubstr("share no motion"));
    for (Column& column : array.columns) {
        if (column.name == "gy3") { column.scale = -1.0; }
    }
    EXPECT_THAT(failure(array, 1), HasSubstr("a gyro 3 whose y does not follow that of gyro 1"));
    for (Column& column : array.columns) { column.unit = "lsb"; }
    EXPECT_THAT(failure(array, 1), HasSubstr("--lsb-dps"));
}

}  // namespace
}  // namespace gyrolog
