#include "analysis/allan/allan_deviation.hpp"

#include <cmath>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "analysis/allan/averaging_factors.hpp"
#include "analysis/allan/deviation_rule.hpp"
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

// The definitions, term by term and with the averages themselves, on a grid where missing samples are NaN.
double average(const std::vector<double>& grid, std::size_t first, std::size_t m) {
    double sum = 0.0;
    for (std::size_t i = first; i < first + m; ++i) { sum += i < grid.size() ? grid[i] : std::nan(""); }
    return sum / static_cast<double>(m);
}

double change_of_average(const std::vector<double>& grid, std::size_t k, std::size_t m) {
    return average(grid, k + m, m) - average(grid, k, m);
}

double windowed(const std::vector<double>& grid, std::size_t k, std::size_t m) {
    double sum = 0.0;
    for (std::size_t i = k; i < k + m; ++i) { sum += change_of_average(grid, i, m); }
    return sum / static_cast<double>(m);
}

double second_difference(const std::vector<double>& grid, std::size_t k, std::size_t m) {
    return change_of_average(grid, k + m, m) - change_of_average(grid, k, m);
}

struct Definition {
    DeviationKind kind;
    double (*term)(const std::vector<double>& grid, std::size_t k, std::size_t m);
    bool strided;
    double norm;
};

const std::vector<Definition> definitions = {
    {DeviationKind::overlapping, change_of_average, false, 2.0},
    {DeviationKind::standard, change_of_average, true, 2.0},
    {DeviationKind::standard_halving, change_of_average, true, 2.0},
    {DeviationKind::modified, windowed, false, 2.0},
    {DeviationKind::hadamard, second_difference, true, 6.0},
    {DeviationKind::overlapping_hadamard, second_difference, false, 6.0},
};

// 0 where there is no term.
double by_definition(const Definition& definition, const std::vector<double>& grid, std::size_t m) {
    double squares = 0.0;
    double terms = 0.0;
    for (std::size_t k = 0; k < grid.size(); k += definition.strided ? m : 1) {
        const double d = definition.term(grid, k, m);
        if (std::isnan(d)) { continue; }
        squares += d * d;
        terms += 1.0;
    }
    return terms > 0.0 ? std::sqrt(squares / (definition.norm * terms)) : 0.0;
}

// Of one unbroken stretch, with theta written out beyond both ends.
struct TotalSum {
    double squares = 0.0;
    double terms = 0.0;
};

TotalSum total_by_definition(std::span<const double> y, std::size_t m) {
    if (2 * m > y.size()) { return {}; }
    const std::size_t last = y.size();
    std::vector<double> theta{0.0};
    for (const double value : y) { theta.push_back(theta.back() + value); }
    const auto reflected = [&](std::ptrdiff_t k) {
        const auto end = static_cast<std::ptrdiff_t>(last);
        if (k < 0) { return 2.0 * theta[0] - theta[static_cast<std::size_t>(-k)]; }
        if (k > end) { return 2.0 * theta[last] - theta[static_cast<std::size_t>(2 * end - k)]; }
        return theta[static_cast<std::size_t>(k)];
    };
    TotalSum sum;
    const auto step = static_cast<std::ptrdiff_t>(m);
    for (std::ptrdiff_t i = 1; i < static_cast<std::ptrdiff_t>(last); ++i) {
        const double d =
            (reflected(i + step) - 2.0 * reflected(i) + reflected(i - step)) / static_cast<double>(m);
        sum.squares += d * d / 2.0;
        sum.terms += 1.0;
    }
    return sum;
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

TEST(AllanDeviation, AcrossHolesUsesTheCompleteTermsAndNoOther) {
    const Holed holed = record_with_holes();
    for (const Definition& definition : definitions) {
        AllanOptions options;
        options.kind = definition.kind;
        options.m = {1, 2, 3, 7, 16, 60, 101};
        if (definition.kind != DeviationKind::modified) {  // m^2 samples in a term
            options.m.insert(options.m.end(), {500, 802, 1024, 1200});
        }
        const AllanCurve curve = allan_deviation(holed.counts, holed.segments, 100.0, options);
        std::size_t points = 0;
        for (const std::int64_t m : options.m) {
            const double expected = by_definition(definition, holed.grid, static_cast<std::size_t>(m));
            if (expected == 0.0) { continue; }
            ASSERT_LT(points, curve.points.size());
            EXPECT_EQ(curve.points[points].m, m);
            EXPECT_NEAR(curve.points[points].deviation, expected, 1e-11 * expected)
                << name_of(definition.kind) << " m " << m;
            ++points;
        }
        EXPECT_EQ(points, curve.points.size()) << name_of(definition.kind);
    }
}

TEST(AllanDeviation, TotalReflectsEachStretchAboutItsOwnEndsAndAveragesOverAllTerms) {
    const Holed holed = record_with_holes();
    const std::vector<double> values = holed.counts.values();
    AllanOptions options;
    options.kind = DeviationKind::total;
    options.m = {1, 2, 7, 50, 51, 500, 750, 1200};
    const AllanCurve curve = allan_deviation(holed.counts, holed.segments, 100.0, options);
    ASSERT_EQ(curve.points.size(), options.m.size());
    for (const AllanPoint& point : curve.points) {
        TotalSum sum;
        for (const Segment& segment : holed.segments) {
            const TotalSum part = total_by_definition(std::span(values).subspan(segment.first, segment.count),
                                                      static_cast<std::size_t>(point.m));
            sum.squares += part.squares;
            sum.terms += part.terms;
        }
        EXPECT_EQ(static_cast<double>(point.terms), sum.terms);
        const double expected = std::sqrt(sum.squares / sum.terms);
        EXPECT_NEAR(point.deviation, expected, 1e-9 * expected) << "m " << point.m;
    }
}

TEST(AllanDeviation, HalvingTakesPowersOfTwoAndTheTextbooksError) {
    const auto y = test::nbs14_1000_point_frequency();
    AllanOptions options;
    options.kind = DeviationKind::standard_halving;
    const AllanCurve curve = allan_deviation(column_of(y), whole(y.size()), 1.0, options);
    ASSERT_EQ(curve.points.size(), 9U);
    std::vector<double> averages = y;
    std::int64_t m = 1;
    for (const AllanPoint& point : curve.points) {
        EXPECT_EQ(point.m, m);
        double squares = 0.0;
        for (std::size_t i = 1; i < averages.size(); ++i) {
            squares += std::pow(averages[i] - averages[i - 1], 2);
        }
        const auto n = static_cast<double>(averages.size());
        EXPECT_NEAR(point.deviation, std::sqrt(squares / (2.0 * (n - 1.0))), 1e-12);
        EXPECT_NEAR(point.hi / point.deviation - 1.0, 1.00064 / std::sqrt(2.0 * (n - 1.0)), 1e-5);
        for (std::size_t i = 0; i < averages.size() / 2; ++i) {
            averages[i] = (averages[2 * i] + averages[2 * i + 1]) / 2.0;
        }
        averages.resize(averages.size() / 2);
        m *= 2;
    }
}

TEST(AllanDeviation, OfEqualSamplesIsZeroWithAnIntervalOfNoLength) {
    for (const DeviationKind kind : all_deviation_kinds) {
        AllanOptions options;
        options.kind = kind;
        for (const double value : {0.0, 1.0 / 3.0, -7e5}) {
            const AllanCurve curve =
                allan_deviation(column_of(std::vector<double>(100, value)), whole(100), 1.0, options);
            EXPECT_GE(curve.points.size(), 6U);
            for (const AllanPoint& point : curve.points) {
                EXPECT_EQ(point.deviation, 0.0);
                EXPECT_EQ(point.lo, 0.0);
                EXPECT_EQ(point.hi, 0.0);
                EXPECT_GE(point.edf, 1.0);
            }
        }
    }
}

TEST(AllanDeviation, OfTheShortestRecordsIsFiniteWithAnIntervalAroundIt) {
    const std::vector<double> y = {3.0, -1.0, 4.0, 1.0, -5.0, 9.0, 2.0, -6.0, 5.0, 3.0};
    for (const DeviationKind kind : all_deviation_kinds) {
        for (const PhaseConvention convention : {PhaseConvention::sp1065, PhaseConvention::matlab}) {
            for (std::size_t samples = 1; samples <= y.size(); ++samples) {
                for (const auto& factors :
                     {std::vector<std::int64_t>{}, {-3, 0, 1, 2, 3, 4, 5, 6, 7, 10, 11, 1000}}) {
                    AllanOptions options;
                    options.kind = kind;
                    options.convention = convention;
                    options.m = factors;
                    const std::vector<double> part(y.begin(),
                                                   y.begin() + static_cast<std::ptrdiff_t>(samples));
                    const AllanCurve curve = allan_deviation(column_of(part), whole(samples), 10.0, options);
                    const std::size_t skipped = convention == PhaseConvention::matlab ? 1 : 0;
                    const std::size_t needed = static_cast<std::size_t>(rule_of(kind).order) + skipped;
                    EXPECT_EQ(curve.points.empty(), samples < needed) << name_of(kind) << ' ' << samples;
                    for (const AllanPoint& point : curve.points) {
                        EXPECT_GT(point.terms, 0);
                        EXPECT_TRUE(std::isfinite(point.hi));
                        EXPECT_LT(point.lo, point.hi);
                        EXPECT_GE(point.edf, 1.0 - 1e-9);
                    }
                }
            }
        }
    }
}

TEST(AllanDeviation, OfOneSampleLessIsTheMatlabConvention) {
    const auto y = test::nbs14_1000_point_frequency();
    const std::vector<double> later(y.begin() + 1, y.end());
    for (const DeviationKind kind : all_deviation_kinds) {
        for (const std::int64_t m : {1, 10, 100}) {
            EXPECT_NEAR(deviation_at(y, m, kind, PhaseConvention::matlab), deviation_at(later, m, kind),
                        1e-12)
                << name_of(kind);
        }
    }
}

TEST(AllanDeviation, HadamardAndNoOtherIgnoresARamp) {
    auto y = test::nbs14_1000_point_frequency();
    for (const DeviationKind kind : all_deviation_kinds) {
        const double before = deviation_at(y, 100, kind);
        auto ramped = y;
        for (std::size_t i = 0; i < ramped.size(); ++i) { ramped[i] += 0.01 * static_cast<double>(i); }
        const double after = deviation_at(ramped, 100, kind);
        if (kind == DeviationKind::hadamard || kind == DeviationKind::overlapping_hadamard) {
            EXPECT_NEAR(after, before, 1e-10);
        } else {
            EXPECT_GT(after, 10.0 * before);
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
    const Holed holed = record_with_holes();
    Column as_reals = holed.counts;
    as_reals.data = holed.counts.values();
    for (const DeviationKind kind : all_deviation_kinds) {
        AllanOptions options;
        options.kind = kind;
        const AllanCurve exact = allan_deviation(holed.counts, holed.segments, 100.0, options);
        const AllanCurve reals = allan_deviation(as_reals, holed.segments, 100.0, options);
        ASSERT_EQ(exact.points.size(), reals.points.size());
        for (std::size_t i = 0; i < exact.points.size(); ++i) {
            EXPECT_NEAR(exact.points[i].deviation, reals.points[i].deviation,
                        1e-12 * exact.points[i].deviation);
            EXPECT_EQ(exact.points[i].terms, reals.points[i].terms);
        }
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
    std::vector<double> y(30000);
    for (double& value : y) { value = normal(random); }
    for (const DeviationKind kind : all_deviation_kinds) {
        AllanOptions options;
        options.kind = kind;
        const AllanCurve one = allan_deviation(column_of(y), whole(y.size()), 1.0, options);
        for (const unsigned threads : {2U, 5U}) {
            options.threads = threads;
            const AllanCurve many = allan_deviation(column_of(y), whole(y.size()), 1.0, options);
            for (std::size_t i = 0; i < one.points.size(); ++i) {
                EXPECT_EQ(one.points[i].deviation, many.points[i].deviation);
                EXPECT_EQ(one.points[i].hi, many.points[i].hi);
            }
        }
    }
}

TEST(AllanDeviation, WithoutIntervalsIsTheSameCurve) {
    const Column column{"gx", "rad/s", std::vector<double>{1, 5, 2, 8, 3, 9, 4, 7, 6, 0}};
    const std::vector<Segment> whole{{0, 10, 0}};
    const AllanCurve with = allan_deviation(column, whole, 10.0);
    const AllanCurve without = allan_deviation(column, whole, 10.0, {.intervals = false});
    ASSERT_EQ(with.points.size(), without.points.size());
    for (std::size_t i = 0; i < with.points.size(); ++i) {
        EXPECT_EQ(without.points[i].deviation, with.points[i].deviation);
        EXPECT_GT(with.points[i].hi, 0.0);
        EXPECT_EQ(without.points[i].hi, 0.0);
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
