#include "analysis/allan/confidence.hpp"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>

#include "analysis/allan/degrees_of_freedom.hpp"
#include "analysis/allan/deviation_sums.hpp"
#include "analysis/allan/power_law.hpp"
#include "analysis/allan/total_variance.hpp"
#include "analysis/allan/variance_distribution.hpp"

namespace gyrolog {
namespace {

std::vector<double> white(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> y(count);
    for (double& value : y) { value = normal(random); }
    return y;
}

std::vector<double> integrated(std::vector<double> y) {
    for (std::size_t i = 1; i < y.size(); ++i) { y[i] += y[i - 1]; }
    return y;
}

std::vector<double> differentiated(std::vector<double> y) {
    for (std::size_t i = y.size() - 1; i > 0; --i) { y[i] -= y[i - 1]; }
    return y;
}

// Half an integration: the fractional filter of 1 / f noise (Kasdin 1995), coefficients h_k = h_{k-1} (k -
// 1/2) / k.
std::vector<double> half_integrated(const std::vector<double>& x) {
    std::vector<double> h{1.0};
    for (std::size_t k = 1; k < x.size(); ++k) {
        const auto n = static_cast<double>(k);
        h.push_back(h.back() * (n - 0.5) / n);
    }
    std::vector<double> y(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t k = 0; k <= i; ++k) { y[i] += h[k] * x[i - k]; }
    }
    return y;
}

TEST(ChiSquareInterval, HasThePublishedLimits) {
    // NIST SP 1065 section 5.3.2: chi-square percentiles; edf 10, 95 %: 3.247 and 20.483.
    const Interval interval = chi_square_interval(1.0, 10.0, 0.95);
    EXPECT_NEAR(interval.lo, std::sqrt(10.0 / 20.483), 2e-5);
    EXPECT_NEAR(interval.hi, std::sqrt(10.0 / 3.247), 1e-4);
}

TEST(ChiSquareInterval, AnswersForMillionsOfDegreesOfFreedom) {
    const Interval interval = chi_square_interval(1.0, 3e6, 0.683);
    // Nearly normal, one sigma 1 / sqrt(2 edf) = 4.082e-4; the chi-square's skewness shows in the fourth
    // digit.
    EXPECT_NEAR(interval.hi - 1.0, 4.085e-4, 1e-6);
    EXPECT_NEAR(1.0 - interval.lo, 4.085e-4, 1e-6);
}

struct NoiseCase {
    PowerLaw law;
    std::vector<double> (*make)(std::size_t, std::uint64_t);
};

const NoiseCase noise_cases[] = {
    {PowerLaw::white_angle, [](std::size_t n, std::uint64_t seed) { return differentiated(white(n, seed)); }},
    {PowerLaw::white_rate, [](std::size_t n, std::uint64_t seed) { return white(n, seed); }},
    {PowerLaw::flicker_rate,
     [](std::size_t n, std::uint64_t seed) { return half_integrated(white(n, seed)); }},
    {PowerLaw::rate_walk, [](std::size_t n, std::uint64_t seed) { return integrated(white(n, seed)); }},
};

double degrees(PowerLaw law, std::int64_t m, std::vector<std::int64_t> runs,
               DeviationKind kind = DeviationKind::overlapping) {
    return DegreesOfFreedom(std::array{law}, rule_of(kind), m, runs).of(law);
}

// The definition of the equivalent degrees of freedom, 2 E(s)^2 / var(s), from many realisations.
double edf_by_simulation(const NoiseCase& noise, std::size_t samples, std::int64_t m, DeviationKind kind,
                         int runs) {
    double sum = 0.0;
    double squares = 0.0;
    for (int run = 0; run < runs; ++run) {
        // A start-up piece is cut off so that filtered noise is stationary in its differences.
        std::vector<double> y = noise.make(2 * samples, 1000 + static_cast<std::uint64_t>(run));
        y.erase(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(samples));
        const Column column{"gx", "rad/s", y, 1.0, 0.0, "rad_s"};
        const std::vector<Segment> whole = {{0, samples, 0}};
        const IntegratedSignal signal(column, whole, PhaseConvention::sp1065);
        const double s = deviation_sums(signal, rule_of(kind), std::array{m}, 1).front();
        sum += s;
        squares += s * s;
    }
    const double mean = sum / runs;
    return 2.0 * mean * mean / (squares / runs - mean * mean);
}

TEST(EquivalentDegreesOfFreedom, AreThoseOfSimulatedNoise) {
    constexpr std::size_t samples = 256;
    constexpr int runs = 600;
    for (const NoiseCase& noise : noise_cases) {
        for (const std::int64_t m : {2, 16, 64}) {
            for (const DeviationKind kind : all_deviation_kinds) {
                const std::int64_t terms = rule_of(kind).terms(samples + 1, m);
                const double edf = degrees(noise.law, m, {terms}, kind);
                // The variance of s is known to sqrt((2 + 12 / edf) / runs); four sigma, and 8 % for noise
                // that is sampled instead of continuous.
                const double tolerance = 4.0 * std::sqrt((2.0 + 12.0 / edf) / runs) + 0.08;
                EXPECT_NEAR(edf_by_simulation(noise, samples, m, kind, runs) / edf, 1.0, tolerance)
                    << "law " << static_cast<int>(noise.law) << ' ' << name_of(kind) << " m " << m;
            }
        }
    }
}

TEST(EquivalentDegreesOfFreedom, AreThePublishedOnesForTotalDeviation) {
    // NIST SP 1065, table 7: 1.500 T / tau, 1.168 T / tau - 0.222, 0.927 T / tau - 0.358.
    const auto total = [](PowerLaw law) { return degrees(law, 100, {999}, DeviationKind::total); };
    EXPECT_NEAR(total(PowerLaw::white_rate), 15.0, 1e-9);
    EXPECT_NEAR(total(PowerLaw::flicker_rate), 11.458, 1e-9);
    EXPECT_NEAR(total(PowerLaw::rate_walk), 8.912, 1e-9);
}

TEST(EquivalentDegreesOfFreedom, DoNotDependOnHowTheLagsAreSummed) {
    // m = 64 is summed lag by lag, m = 65 in pieces; both close to the limit of large m.
    for (const PowerLaw law :
         {PowerLaw::flicker_angle, PowerLaw::white_rate, PowerLaw::flicker_rate, PowerLaw::rate_walk}) {
        const double direct = degrees(law, 64, {64 * 40});
        const double pieces = degrees(law, 65, {65 * 40});
        EXPECT_NEAR(pieces / direct, 1.0, law == PowerLaw::flicker_angle ? 1e-2 : 1e-4)
            << static_cast<int>(law);
    }
}

TEST(EquivalentDegreesOfFreedom, OfOneDifferenceIsOne) {
    EXPECT_DOUBLE_EQ(degrees(PowerLaw::flicker_rate, 1000, {1}), 1.0);
}

TEST(EquivalentDegreesOfFreedom, AddOverRunsThatAreFarApart) {
    const double one = degrees(PowerLaw::white_rate, 10, {500});
    const double two = degrees(PowerLaw::white_rate, 10, {500, 500});
    EXPECT_DOUBLE_EQ(two, 2.0 * one);
}

// Steps of a random walk are independent: their mean square is a chi-square exactly, while its quantiles are
// taken from eigenvalues.
TEST(VarianceDistribution, OfIndependentTermsIsChiSquare) {
    VarianceShares walk{};
    walk[index_of(PowerLaw::rate_walk)] = 2.0;
    for (const std::int64_t terms : {1, 2, 5, 20, 100}) {
        const VarianceDistribution distribution(walk, rule_of(DeviationKind::overlapping), 1,
                                                std::array{terms});
        const auto count = static_cast<double>(terms);
        EXPECT_NEAR(distribution.edf(), count, 1e-9 * count);
        const boost::math::chi_squared exact(count);
        for (const double p : {0.0005, 0.025, 0.1585, 0.5, 0.8415, 0.975, 0.9995}) {
            const double tail = std::min(p, 1.0 - p);
            EXPECT_NEAR(cdf(exact, count * distribution.quantile(p)), p, std::max(0.012, 0.1 / count) * tail)
                << terms << " terms";
        }
    }
}

// Twelve averages are about the most that are worked out by eigenvalues: there chi-square must say the same.
TEST(VarianceDistribution, GoesOverIntoChiSquare) {
    constexpr std::int64_t m = 8400;
    for (const DeviationKind kind : {DeviationKind::overlapping, DeviationKind::modified,
                                     DeviationKind::overlapping_hadamard, DeviationKind::total}) {
        for (const PowerLaw law : {PowerLaw::white_rate, PowerLaw::flicker_rate, PowerLaw::rate_walk}) {
            const DeviationRule& rule = rule_of(kind);
            const std::int64_t terms = rule.terms(100001, m);
            VarianceShares shares{};
            shares[index_of(law)] = 1.0;
            const VarianceDistribution distribution(shares, rule, m, std::array{terms});
            const double edf = degrees(law, m, {terms}, kind);
            const double bias = kind == DeviationKind::total ? total_bias(law, terms, m) : 1.0;
            EXPECT_NEAR(distribution.edf() / edf, 1.0, 0.03) << name_of(kind) << ' ' << static_cast<int>(law);
            for (const double p : {0.1585, 0.8415}) {
                const double q = edf * distribution.quantile(p) / bias;
                EXPECT_NEAR(cdf(boost::math::chi_squared(edf), q), p, 0.02) << name_of(kind);
            }
        }
    }
}

// Why eigenvalues at all: of a third and a quarter of a record, a chi-square with the right degrees of
// freedom covers too much at 68.3 %.
TEST(VarianceDistribution, IsNarrowerThanChiSquareNearTheEndOfTheRecord) {
    constexpr std::int64_t samples = 120000;
    const DeviationRule& rule = rule_of(DeviationKind::overlapping);
    for (const PowerLaw law : {PowerLaw::white_rate, PowerLaw::flicker_rate, PowerLaw::rate_walk}) {
        for (const std::int64_t m : {samples / 3, samples / 4}) {
            VarianceShares shares{};
            shares[index_of(law)] = 1.0;
            const VarianceDistribution exact(shares, rule, m, std::array{rule.terms(samples + 1, m)});
            const boost::math::chi_squared chi_square(exact.edf());
            const auto probability_below = [&](double q) {
                double low = 0.001;
                double high = 0.999;
                for (int i = 0; i < 40; ++i) {
                    const double middle = (low + high) / 2.0;
                    (exact.quantile(middle) < q ? low : high) = middle;
                }
                return low;
            };
            const double covered = probability_below(quantile(chi_square, 0.8415) / exact.edf()) -
                                   probability_below(quantile(chi_square, 0.1585) / exact.edf());
            EXPECT_GT(covered, 0.705) << static_cast<int>(law) << " m " << m;
            EXPECT_LT(covered, 0.76) << static_cast<int>(law) << " m " << m;
        }
    }
}

// Expected total variance over the Allan variance, by simulation.
TEST(TotalVariance, HasThePublishedBias) {
    constexpr std::size_t samples = 256;
    constexpr int runs = 2000;
    for (const NoiseCase& noise : noise_cases) {
        for (const std::int64_t m : {16, 64, 128}) {
            double total = 0.0;
            double allan = 0.0;
            for (int run = 0; run < runs; ++run) {
                std::vector<double> y = noise.make(2 * samples, 5000 + static_cast<std::uint64_t>(run));
                y.erase(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(samples));
                const Column column{"gx", "rad/s", y, 1.0, 0.0, "rad_s"};
                const std::vector<Segment> whole = {{0, samples, 0}};
                const IntegratedSignal signal(column, whole, PhaseConvention::sp1065);
                const auto mean_square = [&](DeviationKind kind) {
                    const DeviationRule& rule = rule_of(kind);
                    return deviation_sums(signal, rule, std::array{m}, 1).front() /
                           static_cast<double>(rule.terms(samples + 1, m));
                };
                total += mean_square(DeviationKind::total);
                allan += mean_square(DeviationKind::overlapping);
            }
            const double bias = total_bias(noise.law, samples - 1, m);
            // Both means are of `runs` estimates with one degree of freedom at least; they are correlated.
            EXPECT_NEAR(total / allan / bias, 1.0, 4.0 * std::sqrt(2.0 / runs))
                << "law " << static_cast<int>(noise.law) << " m " << m;
        }
    }
}

}  // namespace
}  // namespace gyrolog
