#include "analysis/plot/denoise_figure.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/plot/lettering.hpp"
#include "tests/analysis/plot/picture.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t rows = 4000;
constexpr double rate_hz = 100.0;
constexpr TimeSpan at_rest{0.0, 40.0};

// Units gx1, gx2, ..., or gx alone, on each axis.
Recording recording_of(const std::vector<std::string>& axes, std::size_t units) {
    Recording recording;
    recording.name = "array.csv";
    recording.rate_hz = rate_hz;
    recording.segments = {{0, 0, rows}};
    for (const std::string& axis : axes) {
        for (std::size_t unit = 1; unit <= units; ++unit) {
            std::vector<double> values(rows);
            for (std::size_t i = 0; i < rows; ++i) {
                values[i] = 0.1 * std::sin(0.7 * static_cast<double>(i * unit));
            }
            Column column;
            column.name = "g" + axis + (units == 1 ? "" : std::to_string(unit));
            column.data = std::move(values);
            recording.columns.push_back(std::move(column));
        }
    }
    return recording;
}

AxisDenoising denoised(const std::string& axis, std::size_t units, std::vector<DenoiseMethod> methods) {
    AxisDenoising result;
    result.knowledge.axis = axis;
    AllanCurve allan;
    PowerSpectrum spectrum;
    for (int i = 0; i < 20; ++i) {
        const double at = 0.01 * std::pow(1.5, i);
        AllanPoint point;
        point.tau_s = at;
        point.deviation = 0.01 / std::sqrt(at);
        allan.points.push_back(point);
        SpectrumPoint density;
        density.f_hz = at;
        density.density = 1e-4;
        spectrum.points.push_back(density);
        BandwidthPoint bandwidth;
        bandwidth.bandwidth_hz = at;
        bandwidth.kalman.noise_ratio = bandwidth.joint.noise_ratio = 0.01 * at;
        bandwidth.kalman.lag_s = bandwidth.joint.lag_s = 0.1 / at;
        result.trend_curve.push_back(bandwidth);
        result.walk_curve.push_back(bandwidth);
    }
    result.unit_allan.assign(units, allan);
    result.unit_spectra.assign(units, spectrum);
    for (const DenoiseMethod method : methods) {
        DenoisedSignal signal;
        signal.design.method = method;
        signal.design.rate.model = RateModel::walk;
        signal.design.rate.bandwidth_hz = 10.0;
        signal.rate.assign(rows, 0.0);
        signal.allan = allan;
        signal.spectrum = spectrum;
        result.signals.push_back(std::move(signal));
    }
    return result;
}

struct Drawn {
    Recording recording;
    std::vector<AxisDenoising> axes;
    Figure figure;
};

Drawn drawn(const std::vector<std::string>& names, std::size_t units, const PaperSize& paper,
            const std::vector<DenoiseMethod>& methods = {DenoiseMethod::joint}) {
    Drawn all{recording_of(names, units), {}, {}};
    for (const std::string& name : names) { all.axes.push_back(denoised(name, units, methods)); }
    all.figure = figure_of(DenoiseFigure{.recording = all.recording,
                                         .axes = all.axes,
                                         .still = at_rest,
                                         .facts = {"100 Hz", "40 s"},
                                         .paper = paper});
    return all;
}

std::vector<std::string> key_of(const Figure& figure) {
    std::vector<std::string> names;
    for (const Curve& curve : figure.key) { names.push_back(curve.legend.at(0)); }
    return names;
}

TEST(DenoiseFigure, FitsAPageWithLettersThatCanBeReadAndCoverNothing) {
    const std::vector<std::vector<std::string>> axes{{"x"}, {"x", "y"}, {"x", "y", "z"}};
    for (const double width_mm : {88.0, 120.0, 180.0, 420.0}) {
        const PaperSize paper{width_mm, 100.0};
        for (const std::vector<std::string>& names : axes) {
            for (const std::size_t units : {1U, 3U}) {
                const Figure figure = drawn(names, units, paper).figure;
                EXPECT_LE(figure.height_px, paper.pixels(text_height_mm) + 1)
                    << names.size() << " axes, " << width_mm << " mm";
                const Rendering rendering = render(figure);
                ASSERT_TRUE(rendering.ok()) << rendering.problem;
                EXPECT_TRUE(rendering.key.has_value());
            }
        }
    }
    const Rendering rendering = render(drawn(axes.back(), 3, {}).figure);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    EXPECT_THAT(faults_of_letters(rendering.drawing), testing::IsEmpty());
}

TEST(DenoiseFigure, HasAColumnForEachAxisAndABandwidthOfOne) {
    const Figure figure = drawn({"x", "y", "z"}, 1, {}).figure;
    EXPECT_EQ(figure.columns, 3);
    ASSERT_EQ(figure.panels.size(), 4U * 3U + 2U);
    EXPECT_EQ(figure.panels[0].caption, "x: at rest, mean taken off");
    EXPECT_EQ(figure.panels[1].caption, "y: at rest, mean taken off");
    EXPECT_EQ(figure.panels[4].caption, "y: Allan deviation at rest");
    EXPECT_EQ(figure.panels[4].y.title, "") << "it stands at the first one of the row";
    EXPECT_EQ(figure.panels[12].caption, "x: white noise that is left");
    EXPECT_EQ(figure.panels[12].guides.at(0).text, "10 Hz");
}

TEST(DenoiseFigure, NamesEachLineOnceInTheKey) {
    EXPECT_THAT(key_of(drawn({"x"}, 1, {}).figure),
                testing::ElementsAre("before", "joint", "kalman", "rate model trend", "rate model walk"));
    EXPECT_THAT(key_of(drawn({"x"}, 3, {}, {DenoiseMethod::kalman, DenoiseMethod::wavelet}).figure),
                testing::ElementsAre("before: a unit", "kalman", "wavelet", "joint", "rate model trend",
                                     "rate model walk"));
}

}  // namespace
}  // namespace gyrolog
