// Eight real gyros at once (openshoe MIMU4444, MPU-9150 dies): 20 still poses of some 22 s in the first 496
// s. The table that is printed stands in METHODS.md.

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "analysis/denoise/denoise.hpp"
#include "host/formats/recording_csv.hpp"
#include "tests/support/needs.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t units = 8;
constexpr double lsb_dps = 1.0 / 16.4;
// Whole seconds well within the poses, which were told by the standard deviation of seconds.
constexpr TimeSpan poses[] = {{1, 23},    {27, 46},   {51, 70},   {75, 95},   {99, 119},
                              {123, 142}, {147, 167}, {172, 192}, {197, 216}, {221, 240},
                              {244, 267}, {272, 291}, {296, 316}, {321, 341}, {345, 365},
                              {369, 389}, {394, 413}, {418, 438}, {444, 465}, {470, 494}};

class RealArray : public testing::Test {
protected:
    void SetUp() override {
        if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
        CsvReadOptions options;
        options.lsb_dps = lsb_dps;
        options.allow_unscaled_counts = true;
        Result<Recording> read = read_recording_csv(shared_data("mimu8_array/exp1.csv.xz"), options);
        ASSERT_TRUE(read.ok());
        std::vector<Segment> parts;
        for (const TimeSpan& pose : poses) {
            for (const Segment& part : segments_within(read->segments, read->rate_hz, pose)) {
                parts.push_back(part);
            }
        }
        std::vector<const Column*> gyros;
        for (const ArrayAxis& axis : array_axes(*read)) {
            gyros.insert(gyros.end(), axis.units.begin(), axis.units.end());
        }
        still = rows_of(*read, gyros, parts);
    }

    // Fitted once: it takes most of the time.
    const std::vector<AxisKnowledge>& knowledge() const {
        static const std::vector<AxisKnowledge> learned = learn_units(still, std::nullopt);
        return learned;
    }

    Recording still;
};

// Between units, of samples less their pose's mean: turns change the bias by gravity.
std::vector<double> covariance_within_poses(const Recording& still, const ArrayAxis& axis) {
    std::vector<double> covariance(units * units, 0.0);
    double count = 0.0;
    for (const Segment& pose : still.segments) {
        std::vector<double> mean(units, 0.0);
        for (std::size_t i = 0; i < units; ++i) {
            for (std::size_t k = 0; k < pose.count; ++k) {
                mean[i] += axis.units[i]->value(pose.first + k) / static_cast<double>(pose.count);
            }
        }
        for (std::size_t k = pose.first; k < pose.first + pose.count; ++k) {
            for (std::size_t i = 0; i < units; ++i) {
                for (std::size_t j = 0; j < units; ++j) {
                    covariance[i * units + j] +=
                        (axis.units[i]->value(k) - mean[i]) * (axis.units[j]->value(k) - mean[j]);
                }
            }
        }
        count += static_cast<double>(pose.count) - 1.0;
    }
    for (double& c : covariance) { c /= count; }
    return covariance;
}

// Over all choices of so many units: the variance of their plain mean and of the best weights, each over the
// mean variance of all units, times the number of units: 1 is 1/N.
struct ByCount {
    double plain = 0.0;
    double best = 0.0;
};

ByCount by_count(const std::vector<double>& covariance, int count) {
    double one = 0.0;
    for (std::size_t i = 0; i < units; ++i) { one += covariance[i * units + i] / units; }
    ByCount sum;
    double choices = 0.0;
    for (unsigned choice = 0; choice < 1U << units; ++choice) {
        if (std::popcount(choice) != count) { continue; }
        std::vector<std::size_t> which;
        for (std::size_t i = 0; i < units; ++i) {
            if ((choice >> i & 1U) != 0) { which.push_back(i); }
        }
        const std::size_t n = which.size();
        std::vector<double> part(n * n);
        double plain = 0.0;
        for (std::size_t i = 0; i < n * n; ++i) {
            part[i] = covariance[which[i / n] * units + which[i % n]];
            plain += part[i] / static_cast<double>(n * n);
        }
        const std::vector<double> weights = least_variance_weights(part, n);
        double best = 0.0;
        for (std::size_t i = 0; i < n * n; ++i) { best += weights[i / n] * weights[i % n] * part[i]; }
        sum.plain += plain / one * static_cast<double>(n);
        sum.best += best / one * static_cast<double>(n);
        choices += 1.0;
    }
    return {sum.plain / choices, sum.best / choices};
}

TEST_F(RealArray, TheMeanOfUnitsWithOwnTonesFallsAsOneOverTheirNumber) {
    for (const ArrayAxis& axis : array_axes(still)) {
        const std::vector<double> covariance = covariance_within_poses(still, axis);
        std::printf("%s: variance over one unit's, times N: plain mean, best weights\n", axis.name.c_str());
        for (int count = 1; count <= static_cast<int>(units); ++count) {
            const ByCount found = by_count(covariance, count);
            std::printf("  N = %d  %.3f  %.3f\n", count, found.plain, found.best);
            // Samples are some 23000, correlated over a few by tones; 28 pairs.
            EXPECT_NEAR(found.plain, 1.0, 0.08) << axis.name << ' ' << count;
            EXPECT_LE(found.best, found.plain + 1e-12);
        }
    }
}

TEST_F(RealArray, UnitsHaveNextToNothingInCommonAndDifferByTheirTones) {
    for (const AxisKnowledge& axis : knowledge()) {
        std::printf("%s\n", axis.axis.c_str());
        for (const UnitBand& band : axis.bands) {
            std::printf(
                "  %6.3f to %6.3f Hz  correlation %+.3f (chance %.3f)  gain of the mean %.2f, of the best "
                "weights %.2f\n",
                band.from_hz, band.to_hz, band.mean_correlation, band.correlation_sd, band.gain_mean,
                band.gain_best);
        }
        double tones = 0.0;
        double all = 0.0;
        for (std::size_t i = 0; i < units; ++i) {
            const UnitKnowledge& unit = axis.units[i];
            double lines = 0.0;
            for (const SpectralLine& line : unit.lines) { lines += 0.5 * line.amplitude * line.amplitude; }
            const double f_hz = unit.lines.empty() ? 0.0 : unit.lines.front().f_hz;
            std::printf(
                "  unit %zu: sd %.3f dps, lines %.0f %% of its variance, the strongest at %.1f Hz; white "
                "%.3f dps\n",
                i + 1, std::sqrt(unit.variance) * deg_per_rad, 100.0 * lines / unit.variance, f_hz,
                std::sqrt(axis.noise.units[i].white_variance) * deg_per_rad);
            tones += lines;
            all += unit.variance;
        }
        std::printf("  lines in all: %.0f %%\n", 100.0 * tones / all);
        EXPECT_LT(std::abs(axis.bands.front().mean_correlation), 0.05);
    }
}

TEST_F(RealArray, TheFilterDoesBetterThanThePlainMean) {
    DenoiseRequest request;
    request.still = {469.0, 493.0};  // the last pose, from the first sample that is kept
    DenoiseDesign design;
    design.method = DenoiseMethod::kalman;
    request.designs = {design};
    for (const AxisDenoising& axis : denoise(still, knowledge(), request)) {
        std::printf("%s: plain mean 1/%.2f, kalman with a free rate 1/%.2f\n", axis.knowledge.axis.c_str(),
                    axis.unit_variance() / axis.mean_variance,
                    axis.unit_variance() / axis.signals.front().still_variance);
        EXPECT_LT(axis.signals.front().still_variance, axis.mean_variance);
        EXPECT_TRUE(axis.failures.empty()) << axis.failures.size();
    }
}

}  // namespace
}  // namespace gyrolog
