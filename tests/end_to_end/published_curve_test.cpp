// The published Allan curves of an MPU-9250, and a sensor simulated from the model that is fitted to them.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "host/formats/curve_csv.hpp"
#include "host/formats/model_json.hpp"
#include "tests/support/needs.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

constexpr unsigned simulations = 4;

struct Band {
    double least_ratio;
    double most_ratio;
};

// Where the ratio of two measured deviations of the same noise lies, one of them read off a print: the ratio
// of the variances is F-distributed, and reading has a standard deviation of 2 % (the folder's ORIGIN.md).
Band band_of(double edf, double share_outside) {
    const boost::math::fisher_f f(edf, edf);
    const double reading =
        0.02 * boost::math::quantile(boost::math::complement(boost::math::normal(), share_outside / 2.0));
    const double least = std::log(boost::math::quantile(f, share_outside / 2.0)) / 2.0;
    return {std::exp(-std::hypot(least, reading)), std::exp(std::hypot(least, reading))};
}

// On a straight line between its neighbours, both axes logarithmic.
AllanPoint at(const AllanCurve& curve, double tau_s) {
    const auto after = std::ranges::lower_bound(curve.points, tau_s, {}, &AllanPoint::tau_s);
    EXPECT_TRUE(after != curve.points.begin() && after != curve.points.end());
    const AllanPoint& low = *(after - 1);
    const double part = std::log(tau_s / low.tau_s) / std::log(after->tau_s / low.tau_s);
    AllanPoint point = low;
    point.deviation = low.deviation * std::pow(after->deviation / low.deviation, part);
    point.edf = low.edf * std::pow(after->edf / low.edf, part);
    return point;
}

TEST(PublishedSensor, SimulatedFromTheModelOfItsCurvesLiesInTheirBandAtEveryAveragingTime) {
    if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
    const std::string printed = shared_data("published_mpu9250_curve/allan_deviation_deg_per_h.csv");
    const TemporaryFolder folder;
    const ProgramResult fitted =
        run_gyrolog({"analyze", "--curve", printed, "--rate", "100", "--model", folder.path("model.json")});
    ASSERT_EQ(fitted.exit_code, 0) << fitted.err;
    const auto model = read_model(folder.path("model.json"));
    ASSERT_TRUE(model.ok());
    const auto published = read_curve_csv(printed);
    ASSERT_TRUE(published.ok());
    ASSERT_EQ(published->curves.size(), 3U);
    int compared = 0;
    for (unsigned seed = 1; seed <= simulations; ++seed) {
        const Recording night = simulate_recording(*model, {.samples = 4'320'000, .seed = seed});  // 12 h
        for (const PrintedCurve& curve : published->curves) {
            AllanOptions options;
            options.threads = 0;
            const AllanCurve simulated =
                allan_deviation(*night.find("g" + curve.name), night.segments, night.rate_hz, options);
            for (const AllanPoint& point : curve.curve.points) {
                const AllanPoint found = at(simulated, point.tau_s);
                // 95 % for all points of all curves together (Bonferroni).
                const Band band = band_of(found.edf, 0.05 / (simulations * 3.0 * 60.0));
                const double ratio = found.deviation / point.deviation;
                EXPECT_GT(ratio, band.least_ratio)
                    << curve.name << " at " << point.tau_s << " s, seed " << seed;
                EXPECT_LT(ratio, band.most_ratio)
                    << curve.name << " at " << point.tau_s << " s, seed " << seed;
                ++compared;
            }
        }
    }
    EXPECT_EQ(compared, simulations * 3 * 60);
}

}  // namespace
}  // namespace gyrolog
