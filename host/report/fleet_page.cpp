#include "host/report/fleet_page.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/base/counted.hpp"
#include "host/formats/noise_unit.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/report/html.hpp"
#include "host/report/page_frame.hpp"

namespace gyrolog {
namespace {

using Recordings = std::vector<FleetLine>;

const char* unit_of(const std::string& parameter) {
    const auto found = std::ranges::find_if(
        population_parameters, [&](const PopulationParameter& one) { return parameter == one.name; });
    return found == population_parameters.end() ? "" : found->unit;
}

template <typename Wanted>
std::size_t count_if(const Recordings& recordings, const Wanted& wanted) {
    return static_cast<std::size_t>(std::ranges::count_if(recordings, wanted));
}

// "partly 3, known 1"
std::string verdicts_text(const Recordings& recordings) {
    std::map<std::string, std::size_t> counts;
    for (const FleetLine& line : recordings) {
        if (!line.verdict.empty()) { ++counts[line.verdict]; }
    }
    std::vector<std::string> texts;
    texts.reserve(counts.size());
    for (const auto& [verdict, count] : counts) { texts.push_back(fmt::format("{} {}", verdict, count)); }
    return fmt::format("{}", fmt::join(texts, ", "));
}

Html facts_of(const FleetPage& page) {
    const Recordings& all = page.read.recordings;
    std::set<std::string> boards;
    for (const FleetLine& line : all) {
        if (!line.board.empty()) { boards.insert(line.board); }
    }
    const std::size_t errors = count_if(all, [](const FleetLine& line) { return !line.error.empty(); });
    const std::size_t holed =
        count_if(all, [](const FleetLine& line) { return line.missing.value_or(0) > 0; });
    const std::size_t damaged =
        count_if(all, [](const FleetLine& line) { return !line.end.empty() && line.end != "clean"; });
    HtmlTable facts{{}, {}, "facts"};
    const auto add = [&](const char* label, const std::string& text) {
        facts.rows.push_back(cells_of({label, text}));
    };
    add("recordings", format_count(all.size()));
    add("boards", boards.empty() ? "not named" : format_count(boards.size()));
    add("no answer", format_count(page.read.unanswered.size()));
    add("other errors", format_count(errors - page.read.unanswered.size()));
    add("with missing samples", format_count(holed));
    add("with a torn or damaged end", format_count(damaged));
    if (const std::string verdicts = verdicts_text(all); !verdicts.empty()) { add("verdicts", verdicts); }
    return table(facts);
}

Html outliers_of(const FleetPage& page) {
    const auto& outliers = page.population.outliers;
    Html section = element("h2", Html::text("What stands out"));
    if (outliers.empty()) { return section + paragraph("No recording stands out from the others."); }
    HtmlTable list{
        cells_of({"recording", "board", "axis", "parameter", "value", "unit", "robust z"}), {}, "names"};
    for (const OutlyingParameter& one : outliers) {
        const FleetLine& line = page.read.recordings[one.recording];
        list.rows.push_back(cells_of({line.file, line.board, one.axis, one.name, in_digits(one.value, 4),
                                      unit_of(one.name), fmt::format("{:+.1f}", one.z)}));
    }
    return section + table(list) +
           paragraph(
               "Robust z: the distance from the median of the units, in standard deviations between "
               "units that outliers do not widen.",
               "muted");
}

Html spread_table(const MeasuredPopulation& measured) {
    HtmlTable list{
        cells_of({"axis", "units", "median", "standard deviation between units",
                  fmt::format("its {:.3g} % interval", 100.0 * measured.probability), "of the values"}),
        {},
        "numbers"};
    for (const PopulationParameter& parameter : population_parameters) {
        std::vector<HtmlRow> rows;
        for (const MeasuredParameter& one : measured.parameters) {
            if (one.name != parameter.name) { continue; }
            const RobustSpread& spread = one.spread;
            rows.push_back(
                cells_of({one.axis.empty() ? "all" : one.axis, format_count(spread.count),
                          in_digits(spread.median, 4), in_digits(spread.sd, 2),
                          fmt::format("{} to {}", in_digits(spread.sd_lo, 2), in_digits(spread.sd_hi, 2)),
                          in_digits(spread.observed_sd, 2)}));
        }
        if (rows.empty()) { continue; }
        list.rows.push_back(
            {element("b", Html::text(fmt::format("{}, {}", parameter.title, parameter.unit)))});
        std::ranges::move(rows, std::back_inserter(list.rows));
    }
    return table(list) +
           paragraph(
               "Of the values: their standard deviation as measured. Between units: without what the "
               "uncertainty of each measurement adds.",
               "muted");
}

Html spread_of(const FleetPage& page) {
    const MeasuredPopulation& measured = page.population.measured;
    return element("h2", Html::text("How far the units lie apart")) +
           (measured.parameters.empty() ? paragraph("No spread between units can be told.")
                                        : spread_table(measured)) +
           bullet_list(measured.notes) +
           figure(
               page.spread_png,
               "Values of the units, for each parameter and axis, over their median and the standard "
               "deviation between units",
               "Each unit with its standard uncertainty, of several recordings the median; those of an axis "
               "in the order of their values. The grey band is one standard deviation between units about "
               "the median.");
}

struct CauseTally {
    std::set<std::string> axes;
    std::set<std::string> files;
    std::vector<double> shares;
};

std::string share_range(std::vector<double> shares) {
    if (shares.empty()) { return "not known"; }
    const auto [lowest, highest] = std::ranges::minmax(shares);
    const double median = median_of(shares);
    if (shares.size() == 1) { return fmt::format("{:.0f} %", 100.0 * median); }
    return fmt::format("{:.0f} % ({:.0f} to {:.0f})", 100.0 * median, 100.0 * lowest, 100.0 * highest);
}

Html causes_of(const FleetPage& page) {
    const Recordings& all = page.read.recordings;
    const std::size_t diagnosed = count_if(all, [](const FleetLine& line) { return !line.verdict.empty(); });
    if (diagnosed == 0) { return {}; }
    std::map<std::string, CauseTally> tallies;
    for (const FleetLine& line : all) {
        for (const FleetCause& cause : line.causes) {
            CauseTally& tally = tallies[cause.effect];
            tally.axes.insert(cause.axes.begin(), cause.axes.end());
            tally.files.insert(line.file);
            if (cause.share) { tally.shares.push_back(*cause.share); }
        }
    }
    Html section = element("h2", Html::text("Causes"));
    if (tallies.empty()) {
        return section + paragraph(fmt::format("The {} name no cause.", counted(diagnosed, "diagnosis")));
    }
    std::vector<std::pair<std::string, CauseTally>> by_count(tallies.begin(), tallies.end());
    std::ranges::stable_sort(
        by_count, [](const auto& a, const auto& b) { return a.second.files.size() > b.second.files.size(); });
    HtmlTable list{cells_of({"cause", "axes", "recordings", "share of the gap, median (range)"}), {}};
    for (const auto& [effect, tally] : by_count) {
        list.rows.push_back(
            cells_of({effect, tally.axes.empty() ? "all" : fmt::format("{}", fmt::join(tally.axes, ", ")),
                      fmt::format("{} of {}", tally.files.size(), diagnosed), share_range(tally.shares)}));
    }
    return section + table(list);
}

Html errors_of(const FleetPage& page) {
    HtmlTable list{cells_of({"recording", "exit code", "error"}), {}, "errors"};
    for (const FleetLine& line : page.read.recordings) {
        if (line.error.empty()) { continue; }
        list.rows.push_back(
            cells_of({line.file, line.exit ? fmt::format("{}", *line.exit) : "", line.error}));
    }
    Html section = element("h2", Html::text("Errors and no answer"));
    return section + (list.rows.empty() ? paragraph("Every recording has its answer.") : table(list));
}

Html recordings_of(const FleetPage& page) {
    HtmlTable list{
        cells_of({"recording", "board", "length", "missing", "verdict", "gap before, left"}), {}, "names"};
    for (const FleetLine& line : page.read.recordings) {
        if (!line.error.empty()) { continue; }
        const auto gap = [](const std::optional<double>& value) {
            return value ? fmt::format("{:.3g}", *value) : std::string("?");
        };
        const bool has_gap = line.gap_before.has_value();
        list.rows.push_back(
            cells_of({line.file, line.board, line.duration_s ? duration_text(*line.duration_s) : "",
                      line.missing ? format_count(*line.missing) : "", line.verdict,
                      has_gap ? fmt::format("{}, {}", gap(line.gap_before),
                                            gap(line.gap_after ? line.gap_after : line.gap_named))
                              : ""}));
    }
    if (list.rows.empty()) { return {}; }
    return element("h2", Html::text("Recordings")) + table(list);
}

}  // namespace

std::string fleet_html(const FleetPage& page) {
    return whole_page(page.name, element("h1", Html::text(page.name)) + facts_of(page) + outliers_of(page) +
                                     spread_of(page) + causes_of(page) + errors_of(page) +
                                     recordings_of(page));
}

}  // namespace gyrolog
