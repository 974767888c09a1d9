#include "host/fleet/unit_population.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/simulate/counter_random.hpp"
#include "host/formats/model_json.hpp"
#include "tests/host/fleet/made_lines.hpp"

namespace gyrolog {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

// Draws of a stream, one after the other.
class Normals {
public:
    explicit Normals(std::uint32_t stream) : stream_(5, stream) {}
    double next() { return stream_.normal(next_++); }

private:
    RandomStream stream_;
    std::uint64_t next_ = 0;
};

std::vector<FleetLine> fleet(std::size_t units, double bias_sd, double N_sd_rel, double measured_bias_sd) {
    Normals normals(1);
    std::vector<FleetLine> lines;
    for (std::size_t i = 0; i < units; ++i) {
        MadeUnit unit;
        unit.file = "unit-" + std::to_string(i) + ".csv";
        unit.board = "S" + std::to_string(i);
        unit.bias = 0.3 + bias_sd * normals.next() + measured_bias_sd * normals.next();
        unit.bias_sd = measured_bias_sd;
        unit.N = 0.005 * std::exp(N_sd_rel * normals.next());
        lines.push_back(parsed(analysis_of(unit)));
    }
    return lines;
}

const MeasuredParameter* find(const UnitPopulation& population, const std::string& axis,
                              const std::string& name) {
    for (const MeasuredParameter& one : population.measured.parameters) {
        if (one.axis == axis && one.name == name) { return &one; }
    }
    return nullptr;
}

TEST(UnitPopulation, OfTwoHundredUnitsIsGivenBackWithinItsInterval) {
    const UnitPopulation population = population_of(fleet(200, 0.5, 0.04, 0.2));
    EXPECT_EQ(population.measured.units, 200U);
    const MeasuredParameter* bias = find(population, "y", "bias");
    ASSERT_NE(bias, nullptr);
    EXPECT_EQ(bias->spread.count, 200U);
    EXPECT_LT(bias->spread.sd_lo, 0.5);
    EXPECT_GT(bias->spread.sd_hi, 0.5);
    EXPECT_LT(bias->spread.sd, bias->spread.observed_sd) << "without the measurements' own uncertainty";
    EXPECT_NEAR(bias->spread.median, 0.3, 4.0 * 1.2533 * 0.54 / std::sqrt(200.0));
    const MeasuredParameter* N = find(population, "x", "N");
    ASSERT_NE(N, nullptr);
    EXPECT_LT(N->spread.sd_lo, 0.04 * 0.005);
    EXPECT_GT(N->spread.sd_hi, 0.04 * 0.005);
    EXPECT_EQ(find(population, "x", "K"), nullptr) << "identified in no unit";
    EXPECT_THAT(population.measured.notes,
                testing::Contains(HasSubstr("K of x, y, z: identified in 0 of 200")));
}

// Measured, written, drawn from again, and measured: the same spread.
TEST(UnitPopulation, IsADataSheetWhoseUnitsHaveThatSpread) {
    const UnitPopulation measured = population_of(fleet(200, 0.5, 0.04, 0.0));
    const std::string sheet = format_population(measured.measured);
    std::vector<FleetLine> lines;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const auto file = parse_model_file(sheet, "p.json", seed);
        ASSERT_TRUE(file.ok()) << file.error().message;
        EXPECT_TRUE(file->is_drawn);
        const AxisModel& axis = file->model.axes[1];
        MadeUnit unit;
        unit.board = "D" + std::to_string(seed);
        unit.bias = axis.bias_rad_s * deg_per_rad;
        unit.bias_sd = 0.0;
        unit.N = axis.noise.N_rad_per_sqrt_s * deg_per_rad;
        lines.push_back(parsed(analysis_of(unit)));
    }
    const UnitPopulation again = population_of(lines);
    for (const char* name : {"bias", "N"}) {
        const RobustSpread& of_sheet = find(measured, "y", name)->spread;
        const RobustSpread& of_units = find(again, "y", name)->spread;
        EXPECT_LT(of_units.sd_lo, of_sheet.sd) << name;
        EXPECT_GT(of_units.sd_hi, of_sheet.sd) << name;
        EXPECT_NEAR(of_units.median, of_sheet.median, 4.0 * 1.2533 * of_sheet.sd / std::sqrt(200.0)) << name;
    }
}

TEST(UnitPopulation, AUnitOutsideIsFlaggedAndDoesNotHideItself) {
    std::vector<FleetLine> lines = fleet(20, 0.5, 0.04, 0.01);
    MadeUnit odd;
    odd.file = "odd.csv";
    odd.board = "S99";
    odd.N = 0.02;
    lines.push_back(parsed(analysis_of(odd)));
    const UnitPopulation population = population_of(lines);
    ASSERT_THAT(population.outliers, SizeIs(3)) << "its three axes, and nothing else of it or of others";
    for (const OutlyingParameter& one : population.outliers) {
        EXPECT_EQ(one.recording, 20U);
        EXPECT_EQ(one.name, "N");
        EXPECT_GT(one.z, 20.0);
    }
}

// 1 in 2150, however few they are; within four standard deviations, and the 4 % by which the bound is known.
TEST(UnitPopulation, CallsAsFewGaussianUnitsOutliersOfFewAsOfMany) {
    Normals normals(7);
    for (const std::size_t units : {4U, 5U, 9U, 16U, 19U, 20U, 40U}) {
        const std::size_t fleets = 400'000 / units;
        const std::vector<double> uncertainties(units, 0.0);
        std::vector<double> values(units);
        std::size_t alarms = 0;
        for (std::size_t fleet = 0; fleet < fleets; ++fleet) {
            for (double& value : values) { value = normals.next(); }
            const RobustSpread spread = robust_spread(values, uncertainties);
            alarms += static_cast<std::size_t>(std::ranges::count_if(values, [&](double value) {
                return std::abs(value - spread.median) > outlier_bound(units) * spread.observed_sd;
            }));
        }
        const double expected = static_cast<double>(fleets * units) / 2150.0;
        EXPECT_NEAR(static_cast<double>(alarms), expected, 4.0 * std::sqrt(2.0 * expected) + 0.1 * expected)
            << units;
    }
}

TEST(UnitPopulation, AShortRecordingDoesNotStandOutByItsNoise) {
    std::vector<FleetLine> lines = fleet(20, 0.5, 0.04, 0.01);
    MadeUnit brief;
    brief.board = "S99";
    brief.bias = 5.0;
    brief.bias_sd = 4.0;
    lines.push_back(parsed(analysis_of(brief)));
    EXPECT_THAT(population_of(lines).outliers, SizeIs(0));
    brief.bias_sd = 0.01;
    lines.back() = parsed(analysis_of(brief));
    EXPECT_THAT(population_of(lines).outliers, SizeIs(3));
}

TEST(UnitPopulation, RecordingsOfOneBoardAreOneUnit) {
    std::vector<FleetLine> lines = fleet(3, 0.5, 0.04, 0.01);
    lines.push_back(lines[0]);
    lines.push_back(lines[1]);
    const UnitPopulation population = population_of(lines);
    EXPECT_EQ(population.measured.units, 3U);
    EXPECT_TRUE(population.measured.parameters.empty());
    EXPECT_THAT(population.measured.notes,
                testing::Contains(HasSubstr("3 units only, and a spread needs 4")));
}

TEST(UnitPopulation, RatesInRadiansAreTheSameRates) {
    std::vector<FleetLine> lines = fleet(20, 0.5, 0.04, 0.01);
    const double median = find(population_of(lines), "x", "bias")->spread.median;
    for (FleetLine& line : lines) {
        for (FleetAxis& axis : line.axes) {
            axis.unit = "rad/s";
            axis.bias.value = *axis.bias.value * rad_per_deg;
        }
    }
    EXPECT_NEAR(find(population_of(lines), "x", "bias")->spread.median, median, 1e-12);
    for (FleetLine& line : lines) {
        for (FleetAxis& axis : line.axes) { axis.unit = "lsb"; }
    }
    EXPECT_EQ(find(population_of(lines), "x", "bias"), nullptr);
}

TEST(UnitPopulation, HasTheUnitsOneByOne) {
    std::vector<FleetLine> lines = fleet(12, 0.01, 0.02, 0.001);
    lines.push_back(parsed(analysis_of({"again.csv", "S3", 0.9, 0.003})));
    lines.push_back(parsed(analysis_of({"again.csv", "S3", 0.9, 0.003})));
    const UnitPopulation population = population_of(lines);
    const auto bias = std::ranges::find_if(population.parameters,
                                           [](const UnitsOfParameter& one) { return one.name == "bias"; });
    ASSERT_NE(bias, population.parameters.end());
    ASSERT_TRUE(bias->spread);
    EXPECT_THAT(bias->units, SizeIs(12));
    for (const UnitValue& unit : bias->units) {
        const bool is_odd = unit.unit == "S3";
        EXPECT_EQ(unit.stands_out, is_odd) << unit.unit;
        if (is_odd) {
            EXPECT_DOUBLE_EQ(unit.value, 0.9);  // the median of its recordings
            EXPECT_DOUBLE_EQ(unit.uncertainty, 0.003);
        }
    }
}

TEST(UnitPopulation, OfThreeUnitsHasThemWithoutASpread) {
    const UnitPopulation population = population_of(fleet(3, 0.1, 0.1, 0.01));
    EXPECT_THAT(population.measured.parameters, SizeIs(0));
    ASSERT_THAT(population.parameters, testing::Not(testing::IsEmpty()));
    for (const UnitsOfParameter& one : population.parameters) {
        EXPECT_THAT(one.units, SizeIs(3));
        EXPECT_FALSE(one.spread);
        EXPECT_NE(one.name, "K") << "identified in none";
    }
}

}  // namespace
}  // namespace gyrolog
