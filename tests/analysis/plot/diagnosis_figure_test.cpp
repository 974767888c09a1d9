#include "analysis/plot/diagnosis_figure.hpp"

#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/plot/lettering.hpp"
#include "tests/analysis/plot/picture.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t points = 40;

// The recording leaves the model's band for the longer half, and the corrected one nowhere.
GapDomain allan_domain(std::size_t axis, double gap_dB = 4.0) {
    GapDomain domain;
    domain.name = "Allan deviation";
    domain.x_name = "averaging time (s)";
    domain.y_name = "σ(τ) (deg/s)";
    domain.log_x = domain.log_y = true;
    domain.axis = axis;
    for (std::size_t i = 0; i < points; ++i) {
        const double at = 0.01 * std::pow(1.35, static_cast<double>(i));
        const double model = 0.005 / std::sqrt(at);
        const double width = 1.02 + 0.01 * static_cast<double>(i);
        const std::size_t half = points / 2;
        const double off_dB = i < half ? 0.0 : gap_dB * static_cast<double>(i - half) / 20.0;
        const double middle = model * std::pow(10.0, off_dB / 20.0);
        domain.x.push_back(at);
        domain.recording.push_back(middle *
                                   (1.0 + 0.3 * (width - 1.0) * std::sin(3.0 * static_cast<double>(i))));
        domain.before_lo.push_back(model / width);
        domain.before_hi.push_back(model * width);
        domain.after_lo.push_back(middle / width);
        domain.after_hi.push_back(middle * width);
        domain.outside_before.push_back(domain.recording[i] > domain.before_hi[i]);
        domain.outside_after.push_back(false);
    }
    domain.gap_before = 4.13;
    domain.gap_after = 1.08;
    return domain;
}

GapDomain time_domain(std::size_t axis, double duration_s = 7300.0) {
    GapDomain domain;
    domain.name = "rate over time";
    domain.x_name = "time (s)";
    domain.y_name = "rate (deg/s)";
    domain.axis = axis;
    for (std::size_t i = 0; i < points; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(points - 1);
        domain.x.push_back(duration_s * share);
        domain.recording.push_back(0.02 * std::sin(6.0 * share) + 0.002 * std::sin(40.0 * share));
        domain.before_lo.push_back(-0.004);
        domain.before_hi.push_back(0.004);
        domain.after_lo.push_back(0.02 * std::sin(6.0 * share) - 0.004);
        domain.after_hi.push_back(0.02 * std::sin(6.0 * share) + 0.004);
        domain.outside_before.push_back(std::abs(domain.recording[i]) > 0.004);
        domain.outside_after.push_back(i == 7);
    }
    domain.gap_before = 3.1;
    domain.gap_after = 1.2;
    return domain;
}

GapDomain uncorrected(GapDomain domain) {
    domain.after_lo.clear();
    domain.after_hi.clear();
    domain.outside_after.clear();
    return domain;
}

Diagnosis diagnosis_with(std::vector<GapDomain> domains) {
    Diagnosis diagnosis;
    diagnosis.recording_name = "night.csv";
    diagnosis.model_name = "model.json";
    diagnosis.verdict = Verdict::known;
    diagnosis.domains = std::move(domains);
    return diagnosis;
}

Cause cause_with(const std::string& effect, std::vector<std::size_t> axes, Share share, double score) {
    Cause cause;
    cause.finding.effect = effect;
    cause.finding.where.axes = std::move(axes);
    cause.share = share;
    cause.score = score;
    return cause;
}

// Two causes whose shares overlap, one density without a name, and a ninth that is left.
Diagnosis partly_explained() {
    Diagnosis diagnosis = diagnosis_with(
        {allan_domain(0), time_domain(0), allan_domain(1), time_domain(1), allan_domain(2), time_domain(2)});
    diagnosis.verdict = Verdict::partly;
    diagnosis.simulations = 200;
    diagnosis.gap_before = {4.0, 1.0, 3.5, 4.6};
    diagnosis.gap_named = {2.2, 1.0, 2.0, 2.4};
    diagnosis.gap_after = {1.63, 1.0, 1.5, 1.8};
    diagnosis.causes = {cause_with("temp_lag", {0}, {0.62, 0.55, 0.68}, 0.91),
                        cause_with("gauss_markov", {0, 1, 2}, {0.35, 0.2, 0.5}, 0.74)};
    diagnosis.unnamed = {{"density", {}, 0.21}};
    diagnosis.unnamed[0].where.axes = {2};
    return diagnosis;
}

std::vector<std::string> words_of(const Panel& panel) {
    std::vector<std::string> words;
    for (const Callout& callout : panel.callouts) { words.push_back(callout.text); }
    return words;
}

std::vector<std::string> names_of(const Panel& panel) {
    std::vector<std::string> names;
    for (auto name = panel.y.names.rbegin(); name != panel.y.names.rend(); ++name) {
        names.push_back(name->text);
    }
    return names;
}

std::vector<std::string> names_in(const std::vector<Curve>& curves) {
    std::vector<std::string> names;
    for (const Curve& curve : curves) {
        if (!curve.legend.empty()) { names.push_back(curve.legend.front()); }
    }
    return names;
}

TEST(DiagnosisFigure, HasAColumnForEachAxisAndARowForEachWayOfLooking) {
    const Diagnosis diagnosis = diagnosis_with(
        {allan_domain(0), time_domain(0), allan_domain(1), time_domain(1), allan_domain(2), time_domain(2)});
    const Figure figure = figure_of(DiagnosisFigure{diagnosis, "known", {}});
    EXPECT_EQ(figure.columns, 3);
    ASSERT_EQ(figure.panels.size(), 6U);
    EXPECT_EQ(figure.panels[1].caption, "y, gap 4.1 → 1.1: Allan deviation");
    EXPECT_EQ(figure.panels[3].caption, "x, gap 3.1 → 1.2: rate over time");
    EXPECT_EQ(figure.source, "night.csv  |  model.json");
    const Diagnosis uneven = diagnosis_with({allan_domain(0), time_domain(0), allan_domain(1)});
    EXPECT_EQ(figure_of(DiagnosisFigure{uneven, "known", {}}).columns, 2);
    const Diagnosis single = diagnosis_with({allan_domain(0), time_domain(0)});
    EXPECT_EQ(figure_of(DiagnosisFigure{single, "known", {}}).columns, 2);
    const Diagnosis two = diagnosis_with({allan_domain(0), allan_domain(1)});
    EXPECT_EQ(figure_of(DiagnosisFigure{two, "known", {}}).columns, 2);
}

TEST(DiagnosisFigure, ShowsTheSixWaysOfLookingWithTheLargestGaps) {
    std::vector<GapDomain> domains;
    for (int i = 0; i < 9; ++i) {
        domains.push_back(time_domain(0));
        domains.back().name = "way " + std::to_string(i);
        domains.back().gap_before = i == 4 ? 0.5 : 10.0 - i;
    }
    const Diagnosis diagnosis = diagnosis_with(domains);
    const Figure figure = figure_of(DiagnosisFigure{diagnosis, "known", {}});
    ASSERT_EQ(figure.panels.size(), 6U);
    EXPECT_EQ(figure.panels[0].caption, "x, gap 10 → 1.2: way 0");
    EXPECT_EQ(figure.panels[4].caption, "x, gap 5.0 → 1.2: way 5");
}

TEST(DiagnosisFigure, ShowsWhatStandsOutBeforeOrAfterFirst) {
    std::vector<GapDomain> domains;
    for (int i = 0; i < 9; ++i) {
        domains.push_back(time_domain(0));
        domains.back().name = "way " + std::to_string(i);
        domains.back().gap_before = 10.0 - i;
    }
    domains[8].surprise_after_nats = 40.0;
    domains[7].surprise_before_nats = 20.0;
    const Diagnosis diagnosis = diagnosis_with(domains);
    const Figure figure = figure_of(DiagnosisFigure{diagnosis, "known", {}});
    ASSERT_EQ(figure.panels.size(), 6U);
    EXPECT_EQ(figure.panels[0].caption, "x, gap 2.0 → 1.2: way 8");
    EXPECT_EQ(figure.panels[1].caption, "x, gap 3.0 → 1.2: way 7");
    EXPECT_EQ(figure.panels[2].caption, "x, gap 10 → 1.2: way 0");
}

TEST(DiagnosisFigure, HasABarForEveryShareOnTop) {
    const Diagnosis diagnosis = partly_explained();
    const Figure figure = figure_of(DiagnosisFigure{diagnosis, "partly", {}});
    ASSERT_EQ(figure.panels.size(), 7U);
    const Panel& bars = figure.panels[0];
    EXPECT_TRUE(bars.spans_row);
    EXPECT_EQ(names_of(bars), (std::vector<std::string>{"temp_lag on x", "gauss_markov on x, y, z",
                                                        "no name: density on z", "left", "by chance"}));
    // Left is (1.63^2 - 1) / (4^2 - 1), the floor 1 / (4^2 - 1).
    EXPECT_EQ(words_of(bars), (std::vector<std::string>{
                                  "62 (55 to 68) %, probability 91 %", "35 (20 to 50) %, probability 74 %",
                                  "21 %", "11 (8 to 15) %", "7 %, what two simulations differ by"}));
    EXPECT_EQ(bars.curves[0].x, (std::vector<double>{0.0, 0.62}));
    EXPECT_EQ(bars.curves[1].x, (std::vector<double>{0.55, 0.68}));
    EXPECT_EQ(names_in(figure.key),
              (std::vector<std::string>{"recording", "model, 95 %", "with the causes, 95 %",
                                        "outside the model", "outside with the causes"}));
    for (const Panel& panel : figure.panels) { EXPECT_TRUE(names_in(panel.curves).empty()); }
}

// Two fills on each other would have a colour that is neither's, in grey too: the second band has edges only.
TEST(DiagnosisFigure, FillsOneBandOnly) {
    const Diagnosis diagnosis = partly_explained();
    const Panel& panel = figure_of(DiagnosisFigure{diagnosis, "partly", {}}).panels[1];
    const auto is_filled = [](const Curve& curve) { return !curve.lo.empty(); };
    EXPECT_EQ(std::ranges::count_if(panel.curves, is_filled), 1);
    EXPECT_TRUE(is_filled(panel.curves[0]));
    EXPECT_GE(panel.curves.size(), 5U) << "two edges of each band, and the recording";
}

// A curve was held against no simulations, and its shares have no intervals.
TEST(DiagnosisFigure, OfACurveSpeaksOfNoSimulations) {
    Diagnosis diagnosis = partly_explained();
    diagnosis.simulations = 0;
    const Panel bars = figure_of(DiagnosisFigure{diagnosis, "partly", {}}).panels[0];
    EXPECT_EQ(names_of(bars).back(), "best fit");
    EXPECT_EQ(words_of(bars).back(), "7 %, what a free fit leaves");
    EXPECT_EQ(bars.x.title, "share of the gap's square (%); shares may overlap");
}

TEST(DiagnosisFigure, WithoutAGapHasNoBars) {
    Diagnosis diagnosis = partly_explained();
    diagnosis.verdict = Verdict::none;
    EXPECT_FALSE(figure_of(DiagnosisFigure{diagnosis, "no gap", {}}).panels[0].spans_row);
    diagnosis = partly_explained();
    diagnosis.gap_before = {0.9, 1.0, 0.8, 1.1};
    EXPECT_FALSE(figure_of(DiagnosisFigure{diagnosis, "known", {}}).panels[0].spans_row);
}

TEST(DiagnosisFigure, DrawsBarsThatDifferInGreyTooWithTheirNumbers) {
    const Diagnosis diagnosis = partly_explained();
    const Rendering rendering = render(DiagnosisFigure{diagnosis, "partly", {"200 simulations"}});
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    const Picture picture(rendering);
    const PanelPlace& bars = rendering.panels[0];
    EXPECT_TRUE(rendering.key.has_value());
    EXPECT_EQ(bars.words.size(), 5U) << "every bar has room for its words";
    for (std::size_t i = 0; i < bars.words.size(); ++i) {
        EXPECT_NEAR(bars.words[i].centre().y, bars.y.pixel(4.0 - static_cast<double>(i)), 1.0) << i;
    }
    EXPECT_GT(bars.plot.width(), 2.0 * rendering.panels[1].plot.width());
    const auto grey = [](Colour c) { return 0.299 * c.red + 0.587 * c.green + 0.114 * c.blue; };
    const std::array colours_down = {colours::blue, colours::blue, colours::sky, colours::vermillion,
                                     colours::grid};
    for (std::size_t i = 0; i < colours_down.size(); ++i) {
        const double at = bars.y.pixel(static_cast<double>(colours_down.size() - 1 - i) + 0.2);
        EXPECT_TRUE(picture.has(colours_down[i], {bars.x.pixel(0.02), at}, 8)) << i;
    }
    EXPECT_GT(grey(colours::vermillion) - grey(colours::blue), 30.0);
    EXPECT_GT(grey(colours::sky) - grey(colours::vermillion), 30.0);
    EXPECT_GT(grey(colours::grid) - grey(colours::sky), 30.0);
}

TEST(DiagnosisFigure, ShowsALogarithmicQuantityInDecibelsOverTheMiddleOfTheModel) {
    const Diagnosis diagnosis = diagnosis_with({allan_domain(0, 4.0)});
    const Panel panel = figure_of(DiagnosisFigure{diagnosis, "known", {}}).panels.at(0);
    const GapDomain& domain = diagnosis.domains[0];
    const Curve& before = panel.curves.at(0);
    const Curve& recording = panel.curves.at(4);
    for (std::size_t i = 0; i < points; ++i) {
        EXPECT_NEAR(before.hi[i], -before.lo[i], 1e-9);
        EXPECT_NEAR(recording.y[i] - before.hi[i],
                    20.0 * std::log10(domain.recording[i] / domain.before_hi[i]), 1e-9);
    }
    EXPECT_EQ(panel.y.kind, ScaleKind::linear);
    EXPECT_EQ(panel.x.kind, ScaleKind::logarithmic);
}

TEST(DiagnosisFigure, ShowsALinearQuantityInItsUnitAndLongTimesInHours) {
    const Diagnosis diagnosis = diagnosis_with({time_domain(0)});
    const Panel panel = figure_of(DiagnosisFigure{diagnosis, "known", {}}).panels.at(0);
    EXPECT_EQ(panel.y.title, "rate (deg/s)");
    EXPECT_EQ(panel.curves.at(4).y, diagnosis.domains[0].recording);
    EXPECT_EQ(panel.x.title, "time (h)");
    EXPECT_NEAR(panel.curves.at(4).x.back(), 7300.0 / 3600.0, 1e-12);
    const Diagnosis brief = diagnosis_with({time_domain(0, 600.0)});
    EXPECT_EQ(figure_of(DiagnosisFigure{brief, "known", {}}).panels.at(0).x.title, "time (s)");
}

TEST(DiagnosisFigure, MarksWhatLiesOutsideBeforeAndAfter) {
    const Diagnosis diagnosis = diagnosis_with({time_domain(0)});
    const Panel panel = figure_of(DiagnosisFigure{diagnosis, "known", {}}).panels.at(0);
    ASSERT_EQ(panel.curves.size(), 7U);
    const auto outside = std::ranges::count(diagnosis.domains[0].outside_before, true);
    EXPECT_EQ(panel.curves[6].x.size(), static_cast<std::size_t>(outside));
    EXPECT_EQ(panel.curves[5].x.size(), 1U);
    EXPECT_GT(panel.curves[5].marker_size_px, panel.curves[6].marker_size_px) << "which would hide it";
    EXPECT_NE(panel.curves[5].marker, panel.curves[6].marker);
    EXPECT_EQ(panel.curves[5].stroke.width_px, 0.0);
}

TEST(DiagnosisFigure, WithoutCausesHasOneBandAndNoSecondNumber) {
    const Diagnosis diagnosis = diagnosis_with({uncorrected(allan_domain(0))});
    const Figure figure = figure_of(DiagnosisFigure{diagnosis, "unexplained", {}});
    EXPECT_EQ(figure.panels.at(0).caption, "x, gap 4.1: Allan deviation");
    EXPECT_EQ(names_in(figure.key),
              (std::vector<std::string>{"recording", "model, 95 %", "outside the model"}));
}

TEST(DiagnosisFigure, NamesEveryPartOnceInTheKey) {
    const Diagnosis diagnosis = diagnosis_with({allan_domain(0), time_domain(0)});
    EXPECT_EQ(names_in(figure_of(DiagnosisFigure{diagnosis, "known", {}}).key).size(), 5U);
}

// N, B and K are three things: no line leads from one to the next, and each has a box of its own for a band.
TEST(DiagnosisFigure, ShowsThingsSideBySideAsPointsUnderTheirNames) {
    GapDomain coefficients = time_domain(0);
    coefficients.name = "noise coefficients";
    coefficients.x_name = "coefficient";
    coefficients.is_course = false;
    coefficients.categories = {"N", "B"};  // the third one has no name
    coefficients.x = {1.0, 2.0, 3.0};
    coefficients.recording = {22.0, 1.0, -1.0};
    coefficients.before_lo = coefficients.after_lo = {-2.0, -2.0, -2.0};
    coefficients.before_hi = coefficients.after_hi = {2.0, 2.0, 2.0};
    coefficients.outside_before = {true, false, false};
    coefficients.outside_after = {false, false, false};
    const Diagnosis diagnosis = diagnosis_with({coefficients});
    const Figure figure = figure_of(DiagnosisFigure{diagnosis, "known", {}});
    const Panel& panel = figure.panels.at(0);
    std::vector<std::string> names;
    for (const AxisName& name : panel.x.names) { names.push_back(name.text); }
    EXPECT_THAT(names, testing::ElementsAre("N", "B", "3"));
    const Curve& recording = panel.curves.at(4);
    EXPECT_EQ(recording.y, coefficients.recording);
    EXPECT_EQ(recording.stroke.width_px, 0.0);
    EXPECT_NE(recording.marker, Marker::none);
    for (const std::size_t edge : {0U, 1U, 2U, 3U}) {
        const Curve& band = panel.curves.at(edge);
        ASSERT_EQ(band.x.size(), 9U);
        EXPECT_LT(band.x[1], 1.5);
        EXPECT_TRUE(std::isnan(band.y[2])) << "nothing between the boxes";
        EXPECT_GT(band.x[3], 1.5);
    }
    EXPECT_TRUE(render(figure).ok());
}

TEST(DiagnosisFigure, OfOneRowHasItsTitleOnce) {
    const Diagnosis diagnosis =
        diagnosis_with({allan_domain(0), time_domain(0), allan_domain(1), time_domain(1)});
    const Figure figure = figure_of(DiagnosisFigure{diagnosis, "known", {}});
    EXPECT_EQ(figure.panels.at(0).y.title, "over the model (dB)");
    EXPECT_EQ(figure.panels.at(1).y.title, "");
    const Rendering rendering = render(figure);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    EXPECT_NEAR(rendering.panels.at(0).plot.width(), rendering.panels.at(1).plot.width(), 1.0);
}

// 180 mm wide, and not higher than a page.
TEST(DiagnosisFigure, FitsAPageWithLettersThatCanBeReadAndCoverNothing) {
    Diagnosis diagnosis = partly_explained();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const char* name :
             {"gains, latency and clock", "rhythm of the noise", "noise by rate", "bursts"}) {
            diagnosis.domains.push_back(time_domain(axis));
            diagnosis.domains.back().name = name;
            diagnosis.domains.back().y_name = "excess (its sd)";
            diagnosis.domains.back().x_name = "change of the rate (deg/s^2)";
        }
    }
    const Figure figure = figure_of(DiagnosisFigure{diagnosis, "partly explained", {"200 simulations"}});
    EXPECT_EQ(figure.width_px, 2126);
    EXPECT_LE(figure.height_px, PaperSize().pixels(250.0));
    EXPECT_GE(figure.panels.size(), 1U + 3U * 4U);
    const Rendering rendering = render(figure);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    EXPECT_THAT(faults_of_letters(rendering.drawing), testing::IsEmpty());
}

// Panels of all axes below each other would be two pages high: those with the most to see stay.
TEST(DiagnosisFigure, FitsAPageInANarrowColumn) {
    Diagnosis diagnosis = partly_explained();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const char* name : {"rhythm of the noise", "noise by rate", "bursts"}) {
            diagnosis.domains.push_back(time_domain(axis));
            diagnosis.domains.back().name = name;
        }
    }
    diagnosis.domains.back().surprise_before_nats = 1e6;
    const PaperSize paper{88.0, 300.0};
    const Figure figure =
        figure_of(DiagnosisFigure{diagnosis, "partly explained", {"200 simulations"}, paper});
    EXPECT_EQ(figure.columns, 1);
    EXPECT_LE(figure.height_px, paper.pixels(text_height_mm) + 1);
    EXPECT_THAT(figure.panels.at(1).caption, testing::HasSubstr("bursts"));
    const Rendering rendering = render(figure);
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
}

TEST(DiagnosisFigure, DrawsBandsAndMarksThatDifferInGreyToo) {
    const Diagnosis diagnosis = diagnosis_with({allan_domain(0), time_domain(0)});
    const Rendering rendering = render(DiagnosisFigure{diagnosis, "known: temp_lag", {"200 simulations"}});
    ASSERT_TRUE(rendering.ok()) << rendering.problem;
    const Picture picture(rendering);
    const Colour before = mixed(colours::paper, mixed(colours::orange, colours::ink, 0.25), 0.40);
    const Colour after = mixed(colours::blue, colours::ink, 0.2);
    EXPECT_GT(picture.count(before, 8), 2000);
    EXPECT_GT(picture.count(after, 8), 500) << "edges";
    EXPECT_GT(picture.count(colours::vermillion, 30), 100);
    const auto grey = [](Colour c) { return 0.299 * c.red + 0.587 * c.green + 0.114 * c.blue; };
    EXPECT_GT(grey(before) - grey(after), 40.0);
    EXPECT_GT(grey(after) - grey(colours::ink), 40.0);
    EXPECT_TRUE(rendering.key.has_value());
}

TEST(DiagnosisFigure, OfNothingToShowIsStillAPicture) {
    const Diagnosis diagnosis = diagnosis_with({});
    EXPECT_TRUE(render(DiagnosisFigure{diagnosis, "no gap", {}}).ok());
    GapDomain empty = allan_domain(0);
    for (double& value : empty.recording) { value = 0.0; }
    const Diagnosis zeros = diagnosis_with({empty});
    EXPECT_TRUE(render(DiagnosisFigure{zeros, "no gap", {}}).ok());
}

}  // namespace
}  // namespace gyrolog
