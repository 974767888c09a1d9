#include "analysis/plot/share_bars.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "analysis/plot/number_text.hpp"

namespace gyrolog {
namespace {

// At scale 1.
constexpr double bar_px = 29.0;
constexpr double around_bars_px = 100.0;

constexpr std::size_t bars_most = 12;
constexpr double half_bar = 0.34;  // of the distance of two bars
constexpr double half_cap = 0.17;
constexpr double room_for_words = 0.65;  // of the longest bar, behind it: 35 letters
constexpr std::size_t steps_most = 8;
constexpr double step_least = 0.25;

// From dark to light in grey, too.
constexpr Colour cause_colour = colours::blue;
constexpr Colour left_colour = colours::vermillion;
constexpr Colour unnamed_colour = colours::sky;
constexpr Colour floor_colour = colours::grid;

struct Bar {
    std::string name;
    Share share;
    std::string more;  // words behind the numbers
    Colour colour;

    bool has_interval() const { return share.hi > share.lo; }
    double end() const { return std::max({share.value, share.hi, 0.0}); }
};

std::string percent(double share) { return fixed_decimal(100.0 * share, 0); }

std::string on_axes(const std::vector<std::size_t>& axes) {
    std::string text;
    for (const std::size_t axis : axes) {
        text += (text.empty() ? " on " : ", ") + std::string(axis_names.at(axis));
    }
    return text;
}

bool is_simulated(const Diagnosis& diagnosis) { return diagnosis.simulations > 0; }

double excess(double gap, const Gap& of) { return gap * gap - of.floor * of.floor; }

Share left_share(const Diagnosis& diagnosis) {
    const Gap& before = diagnosis.gap_before;
    const Gap& after = diagnosis.gap_after;
    const double whole = excess(before.value, before);
    const auto share = [&](double gap) { return std::max(excess(gap, after), 0.0) / whole; };
    if (!(after.hi > after.lo)) { return {share(after.value), 0.0, 0.0}; }
    return {share(after.value), share(after.lo), share(after.hi)};
}

std::vector<Bar> bars_of(const Diagnosis& diagnosis) {
    std::vector<Bar> bars;
    for (const Cause& cause : diagnosis.causes) {
        bars.push_back({cause.finding.effect + on_axes(cause.finding.where.axes), cause.share,
                        ", probability " + percent(cause.score) + " %", cause_colour});
    }
    for (const Unnamed& unnamed : diagnosis.unnamed) {
        bars.push_back({"no name: " + unnamed.form + on_axes(unnamed.where.axes),
                        {unnamed.share, 0.0, 0.0},
                        "",
                        unnamed_colour});
    }
    if (bars.size() > bars_most) { bars.resize(bars_most); }
    bars.push_back({"left", left_share(diagnosis), "", left_colour});
    const Gap& before = diagnosis.gap_before;
    const double floor = before.floor * before.floor / excess(before.value, before);
    // A curve is not simulated: its floor is what a free fit leaves.
    bars.push_back(is_simulated(diagnosis)
                       ? Bar{"by chance", {floor, 0.0, 0.0}, ", what two simulations differ by", floor_colour}
                       : Bar{"best fit", {floor, 0.0, 0.0}, ", what a free fit leaves", floor_colour});
    return bars;
}

std::string words_of(const Bar& bar) {
    std::string text = percent(bar.share.value);
    if (percent(bar.share.lo) != percent(bar.share.hi)) {
        text += " (" + percent(bar.share.lo) + " to " + percent(bar.share.hi) + ")";
    }
    return text + " %" + bar.more;
}

Curve rectangle(const Bar& bar, double at) {
    Curve curve;
    curve.x = {0.0, bar.share.value};
    curve.y = {at, at};
    curve.lo = {at - half_bar, at - half_bar};
    curve.hi = {at + half_bar, at + half_bar};
    curve.stroke = {bar.colour, 1.0, {}};
    curve.band_opacity = 1.0;
    return curve;
}

Curve line(double from_x, double from_y, double to_x, double to_y) {
    Curve curve;
    curve.x = {from_x, to_x};
    curve.y = {from_y, to_y};
    curve.stroke = {colours::ink, 2.2, {}};
    return curve;
}

void add_interval(Panel& panel, const Share& share, double at) {
    panel.curves.push_back(line(share.lo, at, share.hi, at));
    for (const double end : {share.lo, share.hi}) {
        panel.curves.push_back(line(end, at - half_cap, end, at + half_cap));
    }
}

std::vector<AxisName> percent_ticks(const Range& range, double longest) {
    const double step = step_least * std::ceil(longest / step_least / static_cast<double>(steps_most));
    std::vector<AxisName> ticks;
    const int first = static_cast<int>(std::ceil(range.lo / step));
    const int last = static_cast<int>(std::floor(longest / step + 1e-9));
    for (int number = first; number <= last; ++number) {
        const double at = step * number;
        ticks.push_back({at, percent(at)});
    }
    return ticks;
}

}  // namespace

std::optional<Panel> share_bars(const Diagnosis& diagnosis) {
    const Gap& before = diagnosis.gap_before;
    if (diagnosis.verdict == Verdict::none || !(excess(before.value, before) > 0.0)) { return std::nullopt; }
    const std::vector<Bar> bars = bars_of(diagnosis);
    Panel panel;
    double longest = 1.0;
    double least = 0.0;
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const Bar& bar = bars[i];
        const auto at = static_cast<double>(bars.size() - 1 - i);
        panel.curves.push_back(rectangle(bar, at));
        if (bar.has_interval()) { add_interval(panel, bar.share, at); }
        panel.callouts.push_back({bar.end(), at, words_of(bar), colours::ink, Marker::none, {}, true});
        longest = std::max(longest, bar.end());
        least = std::min({least, bar.share.lo, bar.share.value});
    }
    for (auto bar = bars.rbegin(); bar != bars.rend(); ++bar) {
        panel.y.names.push_back({static_cast<double>(bar - bars.rbegin()), bar->name});
    }
    const auto count = static_cast<double>(bars.size());
    panel.y.range = Range{-0.6, count - 0.4};
    panel.x.range = Range{least, longest * (1.0 + room_for_words)};
    panel.x.names = percent_ticks(*panel.x.range, longest);
    panel.x.title = std::string("share of the gap's square (%)") +
                    (is_simulated(diagnosis) ? ", with its 95 % interval" : "") + "; shares may overlap";
    panel.spans_row = true;
    panel.height_share = around_bars_px + bar_px * count;
    return panel;
}

}  // namespace gyrolog
