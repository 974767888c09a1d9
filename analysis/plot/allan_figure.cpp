#include "analysis/plot/allan_figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/noise/noise_model.hpp"
#include "analysis/plot/number_text.hpp"
#include "analysis/plot/spectrum_panel.hpp"
#include "analysis/plot/trace_look.hpp"
#include "analysis/recording/standard_gravity.hpp"

namespace gyrolog {
namespace {

constexpr double root_s_per_root_h = 60.0;

// sqrt(2 ln 2 / pi): the level of the flat part over B. IEEE Std 952-1997 C.1.3.
const double flat_level = std::sqrt(2.0 * std::log(2.0) / pi);

// Narrower, a table with N in both units would need letters that are too small.
constexpr double two_units_of_N_mm = 120.0;

constexpr double tau_of_N_s = 1.0;
constexpr double tau_of_K_s = 3.0;

// A coefficient's mark may lie beside the data, but not so far that the data would shrink to a corner.
constexpr double mark_beyond_tau = 10.0;
constexpr double mark_beyond_deviation = 100.0;

const std::vector<double> slope_dash_px{2.0, 5.0};

bool is_usable(double value) { return std::isfinite(value) && value > 0.0; }

// What the curves cover on paper.
struct Extent {
    Range tau_s{0.0, 0.0};
    Range deviation{0.0, 0.0};
    bool empty = true;

    void add(Point p) {
        if (!is_usable(p.x) || !is_usable(p.y)) { return; }
        if (empty) {
            tau_s = {p.x, p.x};
            deviation = {p.y, p.y};
            empty = false;
        }
        tau_s = {std::min(tau_s.lo, p.x), std::max(tau_s.hi, p.x)};
        deviation = {std::min(deviation.lo, p.y), std::max(deviation.hi, p.y)};
    }
    bool is_near(Point p) const {
        return p.x > tau_s.lo / mark_beyond_tau && p.x < tau_s.hi * mark_beyond_tau &&
               p.y > deviation.lo / mark_beyond_deviation && p.y < deviation.hi * mark_beyond_deviation;
    }
};

// One trace on its way to a panel.
struct Drafting {
    const AllanTrace& trace;
    const DeviationUnit& unit;
    TraceLook look;

    double on_paper(double value) const { return value * unit.per_unit_of_data; }

    double lowest_tau_s() const;
    Curve measured() const;
    Curve model() const;
    // The line sigma * (tau / tau_s)^slope over the range, and where the data are not far away its mark at
    // (tau_s, sigma).
    void add_slope(Panel& panel, const char* name, Point mark, double slope, Range tau_range_s,
                   const Extent& shown) const;
    void add_slopes(Panel& panel, const Extent& shown) const;
};

double Drafting::lowest_tau_s() const {
    const AllanPoint* lowest = nullptr;
    for (const AllanPoint& p : trace.curve.points) {
        if (!is_usable(p.tau_s) || !is_usable(p.deviation)) { continue; }
        if (lowest == nullptr || p.deviation < lowest->deviation) { lowest = &p; }
    }
    return lowest == nullptr ? 1.0 : lowest->tau_s;
}

Curve Drafting::measured() const {
    Curve curve;
    bool has_band = false;
    for (const AllanPoint& p : trace.curve.points) {
        curve.x.push_back(p.tau_s);
        curve.y.push_back(on_paper(p.deviation));
        if (look.is_one_of_many) { continue; }
        curve.lo.push_back(on_paper(p.lo));
        curve.hi.push_back(on_paper(p.hi));
        has_band = has_band || (is_usable(p.lo) && p.hi > p.lo);
    }
    if (!has_band) {
        curve.lo.clear();
        curve.hi.clear();
    }
    curve.stroke = {look.colour, look.width_px, {}};
    curve.marker = look.marker;
    curve.marker_size_px = 10.0;
    curve.markers_apart_px = 34.0;
    return curve;
}

Curve Drafting::model() const {
    Curve curve;
    for (const ModelPoint& p : trace.model) {
        curve.x.push_back(p.tau_s);
        curve.y.push_back(on_paper(p.deviation));
    }
    curve.stroke = {look.model_colour(), 2.0, model_dash_px};
    curve.sets_range = false;
    return curve;
}

void Drafting::add_slope(Panel& panel, const char* name, Point mark, double slope, Range tau_range_s,
                         const Extent& shown) const {
    Curve line;
    for (const double tau_s : {tau_range_s.lo, tau_range_s.hi}) {
        line.x.push_back(tau_s);
        line.y.push_back(mark.y * std::pow(tau_s / mark.x, slope));
    }
    line.stroke = {look.colour, 1.5, slope_dash_px};
    line.sets_range = false;
    panel.curves.push_back(std::move(line));
    if (shown.is_near(mark)) {
        panel.callouts.push_back({mark.x, mark.y, name, mixed(look.colour, colours::ink, 0.25), look.marker});
    }
}

void Drafting::add_slopes(Panel& panel, const Extent& shown) const {
    if (shown.empty) { return; }
    const Range all = shown.tau_s;
    const auto use = [](const std::optional<PlottedCoefficient>& c) { return c && is_usable(c->value); };
    if (use(trace.N)) {
        const Point mark{tau_of_N_s, on_paper(trace.N->value)};
        add_slope(panel, "N", mark, -0.5, {std::min(all.lo, tau_of_N_s), 10.0 * tau_of_N_s}, shown);
    }
    if (use(trace.B)) {
        const Point mark{trace.B->tau_s.value_or(lowest_tau_s()), flat_level * on_paper(trace.B->value)};
        add_slope(panel, "B", mark, 0.0, {mark.x / 10.0, mark.x * 10.0}, shown);
    }
    if (use(trace.K)) {
        const Point mark{tau_of_K_s, on_paper(trace.K->value)};
        add_slope(panel, "K", mark, 0.5, {tau_of_K_s / 2.0, std::max(all.hi, tau_of_K_s)}, shown);
    }
}

// The table's columns: those for which at least one trace has a value.
struct LegendColumn {
    std::string header;
    std::optional<PlottedCoefficient> AllanTrace::*coefficient;
    double factor;  // from the curve's unit to the header's
};

std::vector<LegendColumn> columns_of(const AllanFigure& allan) {
    const DeviationUnit& unit = allan.unit;
    const double to_paper = unit.per_unit_of_data;
    std::vector<LegendColumn> columns{{"N  (" + unit.name + ")/√Hz", &AllanTrace::N, to_paper}};
    if (!unit.density.name.empty() && allan.paper.width_mm >= two_units_of_N_mm) {
        columns.push_back({"N  " + unit.density.name, &AllanTrace::N, to_paper * unit.density.factor});
    }
    if (unit.has_second_B) {
        columns.push_back({"B  " + unit.deviation.name, &AllanTrace::B, to_paper * unit.deviation.factor});
    } else {
        columns.push_back({"B  " + unit.name, &AllanTrace::B, to_paper});
    }
    columns.push_back({"K  (" + unit.name + ")√Hz", &AllanTrace::K, to_paper});
    columns.erase(std::remove_if(columns.begin(), columns.end(),
                                 [&](const LegendColumn& column) {
                                     return std::none_of(allan.traces.begin(), allan.traces.end(),
                                                         [&](const AllanTrace& t) {
                                                             return (t.*column.coefficient).has_value();
                                                         });
                                 }),
                  columns.end());
    return columns;
}

std::string cell(const std::optional<PlottedCoefficient>& coefficient, double factor) {
    if (!coefficient) { return "–"; }
    std::optional<double> uncertainty;
    if (coefficient->uncertainty) { uncertainty = *coefficient->uncertainty * factor; }
    return number_with_uncertainty(coefficient->value * factor, uncertainty);
}

// Of several traces the smallest and the largest value.
std::string cell(const TraceGroup& group, const LegendColumn& column) {
    if (group.traces.size() == 1) { return cell(group.traces[0]->*column.coefficient, column.factor); }
    std::vector<double> values;
    for (const AllanTrace* trace : group.traces) {
        if (const auto& coefficient = trace->*column.coefficient) {
            values.push_back(coefficient->value * column.factor);
        }
    }
    if (values.empty()) { return "–"; }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return rounded_number(*least) + " … " + rounded_number(*most);
}

std::vector<std::string> legend_row(const TraceGroup& group, const std::vector<LegendColumn>& columns) {
    const std::size_t count = group.traces.size();
    std::vector<std::string> row{count == 1 ? group.name : std::to_string(count) + " × " + group.name};
    for (const LegendColumn& column : columns) { row.push_back(cell(group, column)); }
    return row;
}

// Rows that explain what the curves have in common.
void add_keys(Panel& panel, const AllanFigure& allan, bool has_band) {
    const auto key = [&](const std::string& text) -> Curve& {
        Curve& row = panel.curves.emplace_back();
        row.sets_range = false;
        row.legend = {text};
        row.stroke = {colours::muted_ink, 1.5, {}};
        return row;
    };
    const bool are_many = groups_of(allan.traces).size() < allan.traces.size();
    const auto has_model = [](const AllanTrace& trace) { return !trace.model.empty(); };
    const auto has_model_spectrum = [](const AllanTrace& trace) {
        return !trace.model_spectrum.empty() && !trace.spectrum.points.empty();
    };
    // Of other deviations than Allan's there is no model curve.
    const bool above = std::ranges::any_of(allan.traces, has_model);
    const bool below = std::ranges::any_of(allan.traces, has_model_spectrum);
    if (!are_many && (above || below)) {
        Curve& row = key(above ? "model" : "model of the spectrum");
        row.stroke = {colours::ink, 2.0, model_dash_px};
    }
    if (has_band) {
        Curve& row = key(rounded_number(100.0 * allan.traces.front().curve.confidence) + " % confidence");
        row.lo = row.hi = {0.0};
        row.stroke.width_px = 0.0;
    }
    const auto has_line = [](const AllanTrace& trace) {
        return !trace.lines.empty() && !trace.spectrum.points.empty();
    };
    if (!are_many && std::any_of(allan.traces.begin(), allan.traces.end(), has_line)) {
        Curve& row = key("line in the spectrum");
        row.stroke.width_px = 0.0;
        row.marker = Marker::triangle_down;
    }
    const auto has_slope = [](const AllanTrace& trace) { return trace.N || trace.B || trace.K; };
    if (!are_many && allan.slope_lines && std::any_of(allan.traces.begin(), allan.traces.end(), has_slope)) {
        Curve& row = key("slopes −½, 0, +½ of N, B, K");
        row.stroke = {colours::ink, 1.5, slope_dash_px};
    }
}

// What the model has beside N, B and K, a line each: without it the dashed curve has humps that nothing
// tells.
std::vector<std::string> shaped_terms(const AllanFigure& allan) {
    constexpr std::size_t told_most = 6;
    std::vector<std::string> told;
    const auto size = [&](double value) {
        return rounded_number(value * allan.unit.per_unit_of_data) + " " + allan.unit.name;
    };
    for (const AllanTrace& trace : allan.traces) {
        for (const PlottedGaussMarkov& noise : trace.gauss_markov) {
            told.push_back(trace.name + ": Gauss-Markov, σ " + size(noise.sigma) + ", correlation time " +
                           rounded_number(noise.correlation_s) + " s");
        }
        for (const PlottedSinusoid& line : trace.sinusoids) {
            told.push_back(trace.name + ": sinusoid, amplitude " + size(line.amplitude) + ", " +
                           rounded_number(line.f_hz) + " Hz");
        }
    }
    if (told.size() <= told_most) { return told; }
    const std::size_t more = told.size() - told_most + 1;
    told.resize(told_most - 1);
    told.push_back("and " + std::to_string(more) + " more terms");
    return told;
}

// Marks of one name that lie together have one letter.
void share_letters(std::vector<Callout>& marks) {
    constexpr double together_decades = 0.3;
    const auto decades = [](double a, double b) { return std::abs(std::log10(a / b)); };
    for (std::size_t i = 0; i < marks.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const bool is_near = decades(marks[i].x, marks[k].x) < together_decades &&
                                 decades(marks[i].y, marks[k].y) < together_decades;
            if (marks[i].text.empty() || marks[i].text != marks[k].text || !is_near) { continue; }
            marks[i].text.clear();
            marks[k].word_colour = colours::ink;
        }
    }
}

void add_guides(Panel& panel) {
    const auto is_marked = [&](const char* name) {
        return std::any_of(panel.callouts.begin(), panel.callouts.end(),
                           [&](const Callout& callout) { return callout.text == name; });
    };
    if (is_marked("N")) { panel.guides.push_back({tau_of_N_s, "1 s"}); }
    if (is_marked("K")) { panel.guides.push_back({tau_of_K_s, "3 s"}); }
}

Panel allan_panel(const AllanFigure& allan) {
    Panel panel;
    panel.x = {"averaging time τ (s)", ScaleKind::logarithmic, {}};
    panel.y = {allan.deviation + " σ(τ) (" + allan.unit.name + ")", ScaleKind::logarithmic, {}};
    if (const DeviationUnit::Second& second = allan.unit.deviation; !second.name.empty()) {
        panel.right = SecondUnit{"σ(τ) (" + second.name + ")", second.factor};
    }

    const std::vector<LegendColumn> columns = columns_of(allan);
    if (!columns.empty()) {
        panel.legend_header.emplace_back();
        for (const LegendColumn& column : columns) { panel.legend_header.push_back(column.header); }
    }
    const std::vector<TraceLook> looks = passes_of(allan.traces);
    const std::vector<TraceGroup> groups = groups_of(allan.traces);
    std::vector<Drafting> draftings;
    Extent shown;
    for (std::size_t i = 0; i < looks.size(); ++i) {
        draftings.push_back({allan.traces[i], allan.unit, looks[i]});
        for (const AllanPoint& p : allan.traces[i].curve.points) {
            shown.add({p.tau_s, p.deviation * allan.unit.per_unit_of_data});
        }
    }
    bool has_band = false;
    for (const Drafting& drafting : draftings) {
        if (allan.slope_lines && !drafting.look.is_one_of_many) { drafting.add_slopes(panel, shown); }
    }
    for (const Drafting& drafting : draftings) {
        Curve measured = drafting.measured();
        has_band = has_band || !measured.lo.empty();
        for (const TraceGroup& group : groups) {
            if (group.traces[0] == &drafting.trace) { measured.legend = legend_row(group, columns); }
        }
        panel.curves.push_back(std::move(measured));
        if (!drafting.look.is_one_of_many && !drafting.trace.model.empty()) {
            panel.curves.push_back(drafting.model());
        }
    }
    share_letters(panel.callouts);
    add_keys(panel, allan, has_band);
    if (groups.size() == allan.traces.size()) { panel.notes = shaped_terms(allan); }
    add_guides(panel);

    return panel;
}

}  // namespace

// 1 °/√h = 1 °/h √h, and √h = 60 √s; likewise 1 m/s/√h = 1 (m/s²)/√Hz √h / s.
DeviationUnit DeviationUnit::rad_per_s_as_deg_per_s() {
    return {"°/s", deg_per_rad, {"°/h", s_per_h}, {"°/√h", s_per_h / root_s_per_root_h}, true};
}
DeviationUnit DeviationUnit::rad_per_s() {
    constexpr double deg_per_h = deg_per_rad * s_per_h;
    return {"rad/s", 1.0, {"°/h", deg_per_h}, {"°/√h", deg_per_h / root_s_per_root_h}, true};
}
DeviationUnit DeviationUnit::m_per_s2_as_micro_g() {
    constexpr double micro_g_m_s2 = 1e-6 * standard_gravity_m_s2;
    return {"µg",
            1.0 / micro_g_m_s2,
            {"m/s²", micro_g_m_s2},
            {"m/s/√h", micro_g_m_s2 * root_s_per_root_h},
            false};
}

Figure figure_of(const AllanFigure& allan) {
    Figure figure;
    figure.title = allan.title;
    figure.source = allan.source;
    figure.facts = allan.facts;
    figure.width_px = allan.paper.width_px();
    figure.height_px = allan.paper.pixels(allan.height_mm);
    figure.scale = allan.paper.scale();
    figure.panels.push_back(allan_panel(allan));
    if (has_spectrum(allan)) {
        figure.panels.push_back(spectrum_panel(allan));
        figure.panels.back().height_share = allan.spectrum_height_mm / allan.height_mm;
        figure.height_px += allan.paper.pixels(allan.spectrum_height_mm);
    }
    return figure;
}

Rendering render(const AllanFigure& allan) { return render(figure_of(allan)); }

}  // namespace gyrolog
