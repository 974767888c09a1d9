#include "analysis/allan/allan_deviation.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/allan/averaging_factors.hpp"
#include "tests/analysis/allan/nbs14.hpp"

namespace gyrolog {
namespace {

Column column_of(std::vector<double> values) { return {"gx", "rad/s", std::move(values), 1.0, 0.0, "rad_s"}; }

std::vector<Segment> whole(std::size_t count) { return {{0, count, 0}}; }

double deviation_at(const std::vector<double>& y, std::int64_t m, DeviationKind kind,
                    PhaseConvention convention = PhaseConvention::sp1065) {
    AllanOptions options;
    options.kind = kind;
    options.convention = convention;
    options.m = {m};
    return allan_deviation(column_of(y), whole(y.size()), 1.0, options).points.at(0).deviation;
}

struct Published {
    DeviationKind kind;
    std::vector<std::pair<double, double>> values;  // as printed, and one unit of the last digit
};

// NIST SP 1065, table 31, for m = 1, 2. Two of the numbers printed for hadamard are not the nearest ones to
// 70.806073 (which overlapping_hadamard, the same at m = 1, prints as 70.80607) and 0.03910860560: one unit
// of the last digit is allowed for.
const std::vector<Published> ten_point_values = {
    {DeviationKind::standard, {{91.22945, 1e-5}, {115.8082, 1e-4}}},
    {DeviationKind::standard_halving, {{91.22945, 1e-5}, {115.8082, 1e-4}}},
    {DeviationKind::overlapping, {{91.22945, 1e-5}, {85.95287, 1e-5}}},
    {DeviationKind::modified, {{91.22945, 1e-5}, {74.78849, 1e-5}}},
    {DeviationKind::hadamard, {{70.80608, 2e-5}, {116.7980, 1e-4}}},
    {DeviationKind::overlapping_hadamard, {{70.80607, 1e-5}, {85.61487, 1e-5}}},
    {DeviationKind::total, {{91.22945, 1e-5}, {93.90379, 1e-5}}},
};

// Table 32, for m = 1, 10, 100.
const std::vector<Published> thousand_point_values = {
    {DeviationKind::standard, {{2.922319e-01, 1e-7}, {9.965736e-02, 1e-8}, {3.897804e-02, 1e-8}}},
    {DeviationKind::overlapping, {{2.922319e-01, 1e-7}, {9.159953e-02, 1e-8}, {3.241343e-02, 1e-8}}},
    {DeviationKind::modified, {{2.922319e-01, 1e-7}, {6.172376e-02, 1e-8}, {2.170921e-02, 1e-8}}},
    {DeviationKind::hadamard, {{2.943883e-01, 1e-7}, {1.052754e-01, 1e-7}, {3.910860e-02, 2e-8}}},
    {DeviationKind::overlapping_hadamard, {{2.943883e-01, 1e-7}, {9.581083e-02, 1e-8}, {3.237638e-02, 1e-8}}},
    {DeviationKind::total, {{2.922319e-01, 1e-7}, {9.134743e-02, 1e-8}, {3.406530e-02, 1e-8}}},
};

// To half a unit of the last printed digit.
void expect_published(const std::vector<double>& y, const Published& published,
                      const std::vector<std::int64_t>& m) {
    for (std::size_t i = 0; i < m.size(); ++i) {
        const auto [value, digit] = published.values[i];
        EXPECT_NEAR(deviation_at(y, m[i], published.kind), value, 0.5001 * digit)
            << name_of(published.kind) << " m " << m[i];
    }
}

TEST(AllanDeviation, ReproducesThePublishedTenPointValues) {
    for (const Published& published : ten_point_values) {
        expect_published(test::nbs14_10_point_frequency(), published, {1, 2});
    }
}

TEST(AllanDeviation, ReproducesThePublishedThousandPointValues) {
    for (const Published& published : thousand_point_values) {
        expect_published(test::nbs14_1000_point_frequency(), published, {1, 10, 100});
    }
}

TEST(AllanDeviation, UsesAsManyDifferencesAsTheConventionSays) {
    const auto y = test::nbs14_1000_point_frequency();
    AllanOptions options;
    options.m = {1, 10, 100};
    const auto terms = [&] {
        std::vector<std::int64_t> all;
        for (const AllanPoint& p : allan_deviation(column_of(y), whole(1000), 1.0, options).points) {
            all.push_back(p.terms);
        }
        return all;
    };
    EXPECT_EQ(terms(), (std::vector<std::int64_t>{999, 981, 801}));
    options.convention = PhaseConvention::matlab;
    EXPECT_EQ(terms(), (std::vector<std::int64_t>{998, 980, 800}));
    options.convention = PhaseConvention::sp1065;
    options.kind = DeviationKind::standard;
    EXPECT_EQ(terms(), (std::vector<std::int64_t>{999, 99, 9}));
}

// MathWorks' formula as published: theta = cumsum(omega) tau0, terms theta(1 + 2m : L) - 2 theta(1 + m : L -
// m) + theta(1 : L - 2m), over 2 tau^2 (L - 2m).
TEST(AllanDeviation, MatlabConventionFollowsItsOwnFormula) {
    const auto y = test::nbs14_1000_point_frequency();
    std::vector<double> theta;
    double sum = 0.0;
    for (const double value : y) { theta.push_back(sum += value); }
    for (const std::size_t m : {1U, 10U, 100U, 499U}) {
        double squares = 0.0;
        for (std::size_t i = 0; i + 2 * m < theta.size(); ++i) {
            squares += std::pow(theta[i + 2 * m] - 2.0 * theta[i + m] + theta[i], 2);
        }
        const auto step = static_cast<double>(m);
        const double expected = std::sqrt(squares / (2.0 * step * step * static_cast<double>(1000 - 2 * m)));
        EXPECT_NEAR(deviation_at(y, static_cast<std::int64_t>(m), DeviationKind::overlapping,
                                 PhaseConvention::matlab),
                    expected, 1e-12 * expected);
    }
}

// The definition, term by term, on a grid where missing samples are NaN.
double by_definition(const std::vector<double>& grid, std::size_t m, std::size_t stride) {
    double squares = 0.0;
    double terms = 0.0;
    for (std::size_t k = 0; k + 2 * m <= grid.size(); k += stride) {
        double first = 0.0;
        double second = 0.0;
        for (std::size_t i = 0; i < m; ++i) {
            first += grid[k + i];
            second += grid[k + m + i];
        }
        const double d = (second - first) / static_cast<double>(m);
        if (std::isnan(d)) { continue; }
        squares += d * d;
        terms += 1.0;
    }
    return std::sqrt(squares / (2.0 * terms));
}

struct Holed {
    Column counts;
    std::vector<Segment> segments;
    std::vector<double> grid;
};

// 5000 counts with a big offset, and holes of 1, 37 and 500 samples.
Holed record_with_holes() {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(0.0, 30.0);
    std::vector<std::int16_t> counts;
    Holed holed;
    const auto add = [&](std::size_t samples) {
        holed.segments.push_back({counts.size(), samples, static_cast<std::int64_t>(holed.grid.size())});
        for (std::size_t i = 0; i < samples; ++i) {
            counts.push_back(static_cast<std::int16_t>(std::lround(12000.0 + normal(random))));
            holed.grid.push_back(counts.back());
        }
    };
    const auto miss = [&](std::size_t samples) {
        holed.grid.resize(holed.grid.size() + samples, std::nan(""));
    };
    add(1000);
    miss(1);
    add(1500);
    miss(37);
    add(100);
    miss(500);
    add(2400);
    holed.counts = {"gx", "rad/s", std::move(counts), 1.0, 0.0, "lsb"};
    return holed;
}

TEST(AllanDeviation, AcrossHolesUsesTheCompleteDifferencesAndNoOther) {
    const Holed holed = record_with_holes();
    for (const DeviationKind kind : {DeviationKind::overlapping, DeviationKind::standard}) {
        AllanOptions options;
        options.kind = kind;
        const AllanCurve curve = allan_deviation(holed.counts, holed.segments, 100.0, options);
        ASSERT_GT(curve.points.size(), 50U);
        for (const AllanPoint& point : curve.points) {
            const auto m = static_cast<std::size_t>(point.m);
            const double expected = by_definition(holed.grid, m, kind == DeviationKind::standard ? m : 1);
            EXPECT_NEAR(point.deviation, expected, 1e-11 * expected) << "m " << m;
        }
    }
}

TEST(AllanDeviation, OfSegmentsThatTouchEqualsThatOfTheWholeButForDifferencesAcrossTheSeam) {
    const auto y = test::nbs14_1000_point_frequency();
    AllanOptions options;
    options.m = {1, 10};
    const auto one = allan_deviation(column_of(y), whole(1000), 1.0, options);
    const std::vector<Segment> two = {{0, 400, 0}, {400, 600, 400}};
    const auto parts = allan_deviation(column_of(y), two, 1.0, options);
    EXPECT_EQ(one.points[0].terms - parts.points[0].terms, 1);
    EXPECT_EQ(one.points[1].terms - parts.points[1].terms, 19);
}

TEST(AllanDeviation, CountsAndRealNumbersAgree) {
    Holed holed = record_with_holes();
    const AllanCurve exact = allan_deviation(holed.counts, holed.segments, 100.0);
    holed.counts.data = holed.counts.values();
    const AllanCurve reals = allan_deviation(holed.counts, holed.segments, 100.0);
    ASSERT_EQ(exact.points.size(), reals.points.size());
    for (std::size_t i = 0; i < exact.points.size(); ++i) {
        EXPECT_NEAR(exact.points[i].deviation, reals.points[i].deviation, 1e-12 * exact.points[i].deviation);
        EXPECT_EQ(exact.points[i].terms, reals.points[i].terms);
    }
}

TEST(AllanDeviation, SumsThatLeave32BitsStayExact) {
    std::vector<std::int16_t> counts(200000);
    for (std::size_t i = 0; i < counts.size(); ++i) { counts[i] = i < 100000 ? -30000 : 30000; }
    const Column column{"gx", "rad/s", counts, 1.0, 0.0, "lsb"};
    AllanOptions options;
    options.m = {100000};
    const AllanCurve curve = allan_deviation(column, whole(counts.size()), 1.0, options);
    EXPECT_DOUBLE_EQ(curve.points.at(0).deviation, 60000.0 / std::sqrt(2.0));
}

TEST(AllanDeviation, IsTheSameBitsForAnyNumberOfThreads) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    std::vector<double> y(100000);
    for (double& value : y) { value = normal(random); }
    AllanOptions options;
    const AllanCurve one = allan_deviation(column_of(y), whole(y.size()), 1.0, options);
    for (const unsigned threads : {2U, 5U}) {
        options.threads = threads;
        const AllanCurve many = allan_deviation(column_of(y), whole(y.size()), 1.0, options);
        for (std::size_t i = 0; i < one.points.size(); ++i) {
            EXPECT_EQ(one.points[i].deviation, many.points[i].deviation);
        }
    }
}

TEST(AllanDeviation, IgnoresAConstantBias) {
    auto y = test::nbs14_1000_point_frequency();
    const auto before = allan_deviation(column_of(y), whole(1000), 1.0);
    for (double& value : y) { value += 1e6; }
    const auto after = allan_deviation(column_of(y), whole(1000), 1.0);
    for (std::size_t i = 0; i < before.points.size(); ++i) {
        // 1e6 leaves 1e-10 of each sample.
        EXPECT_NEAR(after.points[i].deviation, before.points[i].deviation, 1e-8 * before.points[i].deviation);
    }
}

TEST(AllanDeviation, ScalesWithTheUnit) {
    const auto y = test::nbs14_1000_point_frequency();
    Column column = column_of(y);
    const auto before = allan_deviation(column, whole(1000), 1.0);
    column.scale = -0.25;
    const auto after = allan_deviation(column, whole(1000), 1.0);
    for (std::size_t i = 0; i < before.points.size(); ++i) {
        EXPECT_EQ(after.points[i].deviation, 0.25 * before.points[i].deviation);
    }
}

TEST(AllanDeviation, DoesNotKnowWhichWayTimeRuns) {
    auto y = test::nbs14_1000_point_frequency();
    const auto before = allan_deviation(column_of(y), whole(1000), 1.0);
    std::reverse(y.begin(), y.end());
    const auto after = allan_deviation(column_of(y), whole(1000), 1.0);
    for (std::size_t i = 0; i < before.points.size(); ++i) {
        EXPECT_NEAR(after.points[i].deviation, before.points[i].deviation, 1e-11);
    }
}

TEST(AllanDeviation, OfWhiteNoiseFallsAsOneOverTheRootOfTau) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    std::vector<double> y(200000);
    for (double& value : y) { value = normal(random); }
    for (const AllanPoint& point : allan_deviation(column_of(y), whole(y.size()), 1.0).points) {
        const double expected = 1.0 / std::sqrt(point.tau_s);
        // Five sigma of an estimate with edf degrees of freedom.
        if (point.edf > 20.0) {
            EXPECT_NEAR(point.deviation / expected, 1.0, 5.0 / std::sqrt(2.0 * point.edf));
        }
    }
}

TEST(AllanDeviation, OfARampIsItsSlopeTimesTauOverRootTwo) {
    std::vector<double> y;
    for (int i = 0; i < 1000; ++i) { y.push_back(0.5 * i); }
    EXPECT_NEAR(deviation_at(y, 10, DeviationKind::overlapping), 0.5 * 10.0 / std::sqrt(2.0), 1e-9);
}

TEST(AllanDeviation, OfNothingIsAnEmptyCurve) {
    EXPECT_TRUE(allan_deviation(column_of({}), {}, 1.0).points.empty());
    EXPECT_TRUE(allan_deviation(column_of({1.0}), whole(1), 1.0).points.empty());
}

TEST(AveragingFactors, AreTheNinetyThreeOfTheTwelveHourExample) {
    const auto m = averaging_factors(4'320'000);
    EXPECT_EQ(m.size(), 93U);
    EXPECT_EQ(m.front(), 1);
    EXPECT_EQ(m.back(), 2'097'152);  // a rounded logarithm would give one more
}

TEST(AveragingFactors, RiseFromOneToTheLargestPowerOfTwoWithinHalfTheRecord) {
    EXPECT_TRUE(averaging_factors(1).empty());
    EXPECT_EQ(averaging_factors(2), std::vector<std::int64_t>{1});
    EXPECT_EQ(averaging_factors(9), (std::vector<std::int64_t>{1, 2, 3, 4}));
    EXPECT_EQ(averaging_factors(std::int64_t{1} << 40).back(), std::int64_t{1} << 39);
}

}  // namespace
}  // namespace gyrolog
