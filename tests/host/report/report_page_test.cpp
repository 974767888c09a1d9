#include "host/report/report_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/host/formats/diagnosis_cases.hpp"
#include "tests/host/report/page_reading.hpp"

namespace gyrolog {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* hostile = R"(<script src="http://evil">x</script>&')";
constexpr const char* harmless = "&lt;script src=&quot;http://evil&quot;&gt;x&lt;/script&gt;&amp;&#39;";

AnalysisReport one_axis() {
    AnalysisReport analysis;
    analysis.name = "night.csv";
    analysis.rate_hz = 100.0;
    analysis.stamps = StampKind::sampling;
    analysis.duration_s = 3600.0;
    analysis.samples = 360'000;
    analysis.unit = {"dps", deg_per_rad};
    AxisReport axis;
    axis.axis = "x";
    FittedCoefficient& N = axis.fit.terms.at(static_cast<std::size_t>(NoiseTerm::N));
    N.state = FittedCoefficient::State::identified;
    N.value = 0.01 * rad_per_deg;
    N.sd = 0.0001 * rad_per_deg;
    axis.fit.terms.at(static_cast<std::size_t>(NoiseTerm::K)).upper = 2e-4 * rad_per_deg;
    analysis.axes = {axis};
    return analysis;
}

ReportPage page_of(const AnalysisReport& analysis) { return {analysis, {}, {}, {}}; }

TEST(ReportPage, TellsNEverywhereInTheUnitThatPeopleUse) {
    const AnalysisReport analysis = one_axis();
    const std::string html = report_html(page_of(analysis));
    EXPECT_THAT(html, HasSubstr("°/s/√Hz</th><td>0.01000 ± 0.00010</td>"));
    EXPECT_THAT(html, HasSubstr("°/√h</th><td>0.6000 ± 0.0060</td>"));  // 60 √s in √h
    EXPECT_THAT(html, HasSubstr("°/h/√Hz</th><td>36.00 ± 0.36</td>"));  // 3600 s in an hour
    EXPECT_THAT(html, HasSubstr("rad/s/√Hz</th><td>(1.745 ± 0.017)e-04</td>"));
    EXPECT_THAT(html, HasSubstr("°/s·√Hz</th><td>&lt; 0.0002</td>"));
    EXPECT_THAT(html,
                HasSubstr("after 1 min the angle is off by 0.077° (1 σ, the noisiest axis)"));  // 0.01 √60
}

TEST(ReportPage, TellsNoAngleOfCountsWithoutAScale) {
    AnalysisReport analysis = one_axis();
    analysis.unit = {"lsb", 1.0};
    const std::string html = report_html(page_of(analysis));
    EXPECT_THAT(html, AllOf(HasSubstr("lsb/sqrt(Hz)"), Not(HasSubstr("°/√h")), Not(HasSubstr("off by"))));
}

TEST(ReportPage, TakesNoMarkupFromAnyName) {
    AnalysisReport analysis = one_axis();
    analysis.name = hostile;
    analysis.warnings = {hostile};
    Diagnosis diagnosis = test::partly();
    diagnosis.recording_name = diagnosis.model_name = hostile;
    diagnosis.warnings = diagnosis.next_recordings = {hostile};
    ReportPage page = page_of(analysis);
    page.about = {{"board", hostile}};
    page.dropouts = {{1.0, 2, hostile}};
    page.diagnosis = &diagnosis;
    const std::string html = report_html(page);
    EXPECT_THAT(html, Not(HasSubstr("<script")));
    EXPECT_THAT(test::unclosed(html), IsEmpty());
    // The title, the heading, what the board is, a dropout's cause, and so on: each is there to be read.
    EXPECT_GE(test::all_between(html, harmless, "<").size(), 9U);
}

TEST(ReportPage, SaysOfADiagnosisWhatTheTextSays) {
    const AnalysisReport analysis = one_axis();
    const Diagnosis diagnosis = test::partly();
    ReportPage page = page_of(analysis);
    EXPECT_THAT(report_html(page), Not(HasSubstr("Against")));
    page.diagnosis = &diagnosis;
    const std::string html = report_html(page);
    EXPECT_THAT(
        html,
        HasSubstr("partly: temp_lag on x (0.021 deg/s per degC, 6.83 min) explains 83 % of the gap</p>"));
    EXPECT_THAT(html, HasSubstr("the model as it is</th><td>7.9 (7.1 to 8.8)</td>"));
    EXPECT_THAT(html, HasSubstr("with the causes in it</th><td>3.4 (3 to 3.9)</td>"));
    EXPECT_THAT(html, HasSubstr("and what has no name</th><td>1.1 (0.9 to 1.4)</td>"));
    for (const char* cell :
         {">temp_lag</th>", "<td>x</td>", "<td>0.0210 ± 0.0020 deg/s per degC; 6.8 ± 1.0 min</td>",
          "<td>62 % (55 to 68)</td>", "<td>91 %</td>"}) {
        EXPECT_THAT(html, HasSubstr(cell));
    }
    EXPECT_THAT(html, HasSubstr("cannot tell it from `temp_linear`"));
    EXPECT_THAT(html, HasSubstr("without a name, a spectrum"));
    EXPECT_THAT(html, HasSubstr("One sweep of the temperature."));
    EXPECT_THAT(html, HasSubstr("a warning"));
}

TEST(ReportPage, SaysWhatIsNotKnownOfTheRecording) {
    AnalysisReport analysis = one_axis();
    EXPECT_THAT(report_html(page_of(analysis)), HasSubstr("missing</th><td>none</td>"));
    analysis.stamps = StampKind::none;
    EXPECT_THAT(report_html(page_of(analysis)), HasSubstr("missing</th><td>not known"));
    EXPECT_THAT(report_html(page_of(analysis)), HasSubstr("temperature</th><td>not recorded"));
    ReportPage page = page_of(analysis);
    page.temperature = TemperatureRange{21.5, 23.25};
    EXPECT_THAT(report_html(page), HasSubstr("21.50 °C to 23.25 °C"));
}

}  // namespace
}  // namespace gyrolog
