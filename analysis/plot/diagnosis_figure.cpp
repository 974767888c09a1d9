#include "analysis/plot/diagnosis_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "analysis/noise/noise_model.hpp"
#include "analysis/plot/number_text.hpp"
#include "analysis/plot/share_bars.hpp"

namespace gyrolog {
namespace {

constexpr double diagnosis_heading_px = 90.0;
constexpr double diagnosis_fact_line_px = 27.0;
constexpr double diagnosis_key_px = 86.0;  // in two lines
constexpr double domain_row_px = 246.0;
constexpr double lone_panel_px = 520.0;
constexpr int diagnosed_columns_most = 3;
constexpr std::size_t rows_most = 6;
constexpr std::size_t rows_least = 3;

// From light to dark in grey, too: band before, band after, recording. Only the first is filled: two fills on
// each other have a colour that is neither's.
constexpr Colour before_colour = colours::orange;
constexpr Colour after_colour = colours::blue;
constexpr Colour measured_colour = colours::ink;

const Stroke before_edge{mixed(before_colour, colours::ink, 0.25), 1.3, {6.0, 4.0}};
const Stroke after_edge{mixed(after_colour, colours::ink, 0.2), 2.0, {}};
const Stroke measured_line{measured_colour, 2.2, {}};
constexpr double before_opacity = 0.40;

constexpr double least_decibels = 1.0;

// Of things side by side: what the bands of model and causes are wide, in their distance.
constexpr double before_half_width = 0.36;
constexpr double after_half_width = 0.24;

enum class Part { recording, before, after, outside_before, outside_after };

// A domain as it is drawn: in its own unit, or over the middle of the first band in dB.
class DomainPanel {
public:
    DomainPanel(const GapDomain& domain, double band_probability)
        : domain_(domain),
          percent_(rounded_number(100.0 * band_probability, 2) + " %"),
          x_(domain.x),
          x_name_(domain.x_name) {
        const bool is_long =
            std::ranges::any_of(domain.x, [](double x) { return std::abs(x) > hours_from_s; });
        if (!domain.log_x && domain.x_name == "time (s)" && is_long) {
            for (double& x : x_) { x /= s_per_h; }
            x_name_ = "time (h)";
        }
    }

    bool has(Part part) const {
        switch (part) {
            case Part::recording:
            case Part::before:
                return true;
            case Part::after:
                return !domain_.after_lo.empty();
            case Part::outside_before:
                return std::ranges::count(domain_.outside_before, true) > 0;
            case Part::outside_after:
                return has(Part::after) && std::ranges::count(domain_.outside_after, true) > 0;
        }
        return false;
    }

    // A curve without points that looks like the part.
    Curve key(Part part) const {
        Curve curve;
        switch (part) {
            case Part::recording:
                curve.stroke = measured_line;
                break;
            case Part::before:
                curve.lo = curve.hi = {0.0};
                curve.stroke = before_edge;
                curve.band_opacity = before_opacity;
                break;
            case Part::after:
                curve.stroke = after_edge;
                break;
            case Part::outside_before:
            case Part::outside_after:
                curve = marks_look(part);
                break;
        }
        curve.legend = {words_for(part)};
        return curve;
    }

    Panel panel() const {
        Panel panel;
        panel.caption = caption();
        panel.x = {x_name_, domain_.log_x ? ScaleKind::logarithmic : ScaleKind::linear, {}};
        panel.y = {domain_.log_y ? "over the model (dB)" : domain_.y_name, ScaleKind::linear, range()};
        const Band before{domain_.before_lo, domain_.before_hi, before_edge, before_half_width,
                          before_opacity};
        const Band after{domain_.after_lo, domain_.after_hi, after_edge, after_half_width, {}};
        add_band(panel, before);
        if (has(Part::after)) { add_band(panel, after); }
        panel.curves.push_back(recording());
        if (!domain_.is_course) { name_things(panel); }
        // The smaller ones over the larger ones.
        for (const Part part : {Part::outside_after, Part::outside_before}) {
            if (has(part)) { panel.curves.push_back(marks(part)); }
        }
        return panel;
    }

private:
    std::string words_for(Part part) const {
        switch (part) {
            case Part::recording:
                return "recording";
            case Part::before:
                return "model, " + percent_;
            case Part::after:
                return "with the causes, " + percent_;
            case Part::outside_before:
                return "outside the model";
            case Part::outside_after:
                return "outside with the causes";
        }
        return {};
    }

    // The numbers first: a long name is shortened at its end.
    std::string caption() const {
        std::string text = (domain_.of_all_axes ? "all axes" : domain_.axis_text()) + ", gap " +
                           rounded_number(domain_.gap_before, 2);
        if (has(Part::after)) { text += " → " + rounded_number(domain_.gap_after, 2); }
        return text + ": " + domain_.name;
    }

    std::vector<double> shown(const std::vector<double>& values) const {
        if (!domain_.log_y) { return values; }
        const std::size_t count =
            std::min({values.size(), domain_.before_lo.size(), domain_.before_hi.size()});
        std::vector<double> dB;
        dB.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            const double middle = std::sqrt(domain_.before_lo[i] * domain_.before_hi[i]);
            dB.push_back(20.0 * std::log10(values[i] / middle));
        }
        return dB;
    }

    // Of things side by side the recording has points: no line leads from one to the next.
    Curve recording() const {
        Curve curve;
        curve.x = x_;
        curve.y = shown(domain_.recording);
        curve.stroke = measured_line;
        if (!domain_.is_course) {
            curve.stroke.width_px = 0.0;
            curve.marker = Marker::circle;
            curve.markers_apart_px = 0.0;
        }
        return curve;
    }

    void name_things(Panel& panel) const {
        panel.x.range = Range{0.5, static_cast<double>(x_.size()) + 0.5};
        for (std::size_t i = 0; i < x_.size(); ++i) {
            panel.x.names.push_back(
                {x_[i], i < domain_.categories.size() ? domain_.categories[i] : fixed_decimal(x_[i], 0)});
        }
    }

    struct Band {
        const std::vector<double>& lo;
        const std::vector<double>& hi;
        const Stroke& edge;
        double half_width;  // of things side by side, each of which has a box of its own
        std::optional<double> opacity;
    };

    std::vector<double> along_x(double half_width) const {
        if (domain_.is_course) { return x_; }
        std::vector<double> edges;
        for (const double x : x_) {
            edges.insert(edges.end(), {x - half_width, x + half_width, x + half_width});
        }
        return edges;
    }

    // Each value at both edges of its box, and nothing between the boxes.
    std::vector<double> along_y(const std::vector<double>& values) const {
        std::vector<double> y = shown(values);
        if (domain_.is_course) { return y; }
        std::vector<double> boxes;
        for (const double value : y) { boxes.insert(boxes.end(), {value, value, std::nan("")}); }
        return boxes;
    }

    // With both edges as lines: where bands lie on each other, only these tell them apart.
    void add_band(Panel& panel, const Band& band) const {
        Curve upper;
        upper.x = along_x(band.half_width);
        upper.y = along_y(band.hi);
        upper.stroke = band.edge;
        Curve lower;
        lower.x = upper.x;
        lower.y = along_y(band.lo);
        lower.stroke = band.edge;
        if (band.opacity) {
            upper.lo = lower.y;
            upper.hi = upper.y;
            upper.band_opacity = *band.opacity;
        }
        panel.curves.push_back(std::move(upper));
        panel.curves.push_back(std::move(lower));
    }

    static Curve marks_look(Part part) {
        const bool is_before = part == Part::outside_before;
        Curve marks;
        marks.stroke = {is_before ? colours::vermillion : colours::purple, 0.0, {}};
        marks.marker = is_before ? Marker::circle : Marker::diamond;
        marks.marker_size_px = is_before ? 8.0 : 13.0;
        marks.markers_apart_px = 0.5 * marks.marker_size_px;
        return marks;
    }

    Curve marks(Part part) const {
        const bool is_before = part == Part::outside_before;
        const std::vector<bool>& outside = is_before ? domain_.outside_before : domain_.outside_after;
        const std::vector<double> y = shown(domain_.recording);
        Curve marks = marks_look(part);
        for (std::size_t i = 0; i < std::min({outside.size(), x_.size(), y.size()}); ++i) {
            if (!outside[i]) { continue; }
            marks.x.push_back(x_[i]);
            marks.y.push_back(y[i]);
        }
        return marks;
    }

    Range range() const {
        RangeFinder finder(ScaleKind::linear);
        if (domain_.log_y) {
            finder.add(-least_decibels);
            finder.add(least_decibels);
        }
        for (const std::vector<double>* values : {&domain_.recording, &domain_.before_lo, &domain_.before_hi,
                                                  &domain_.after_lo, &domain_.after_hi}) {
            for (const double value : shown(*values)) { finder.add(value); }
        }
        return finder.padded(0.06, 0.0);
    }

    const GapDomain& domain_;
    std::string percent_;
    std::vector<double> x_;
    std::string x_name_;
};

// How much there is to see: what stands out before or after, or else how far it is off.
std::pair<double, double> rank_of(const GapDomain* domain) {
    return {std::max(domain->surprise_before_nats, domain->surprise_after_nats),
            std::max(domain->gap_before, domain->gap_after)};
}

// One way of looking, on the axes that have it.
struct Row {
    std::string name;
    std::vector<const GapDomain*> domains;  // by axis

    bool is_whole(std::size_t axes) const { return domains.size() == axes; }

    std::pair<double, double> rank() const {
        std::pair<double, double> most;
        for (const GapDomain* domain : domains) { most = std::max(most, rank_of(domain)); }
        return most;
    }
};

std::vector<Row> rows_of(const Diagnosis& diagnosis) {
    std::vector<Row> rows;
    for (const GapDomain& domain : diagnosis.domains) {
        if (domain.x.size() < 2) { continue; }  // a single number is no curve
        auto row = std::ranges::find(rows, domain.name, &Row::name);
        if (row == rows.end()) { row = rows.insert(rows.end(), {domain.name, {}}); }
        row->domains.push_back(&domain);
    }
    for (Row& row : rows) { std::ranges::stable_sort(row.domains, {}, &GapDomain::axis); }
    return rows;
}

std::size_t axes_in(const Diagnosis& diagnosis) {
    std::vector<std::size_t> axes;
    for (const GapDomain& domain : diagnosis.domains) {
        if (std::ranges::count(axes, domain.axis) == 0) { axes.push_back(domain.axis); }
    }
    return axes.size();
}

// The rows with the most to see, but whole ones before those that lack an axis.
std::vector<Row> shown_rows(const Diagnosis& diagnosis, std::size_t most) {
    std::vector<Row> rows = rows_of(diagnosis);
    std::ranges::stable_sort(rows, std::ranges::greater(), &Row::rank);
    if (rows.size() > most) { rows.resize(most); }
    const std::size_t axes = axes_in(diagnosis);
    std::stable_partition(rows.begin(), rows.end(), [&](const Row& row) { return row.is_whole(axes); });
    return rows;
}

constexpr std::array all_parts = {Part::recording, Part::before, Part::after, Part::outside_before,
                                  Part::outside_after};

// What the panels show, each once.
std::vector<Curve> key_of(const std::vector<DomainPanel>& panels) {
    std::vector<Curve> key;
    for (const Part part : all_parts) {
        const auto has = [&](const DomainPanel& panel) { return panel.has(part); };
        const auto first = std::ranges::find_if(panels, has);
        if (first != panels.end()) { key.push_back(first->key(part)); }
    }
    return key;
}

// What is drawn below the bars.
struct DrawnRows {
    std::vector<const GapDomain*> domains;
    std::size_t columns = 1;
};

DrawnRows drawn_rows(const Diagnosis& diagnosis, const PaperSize& paper, double left_px) {
    const auto held = static_cast<std::size_t>(std::max(left_px, 0.0) / domain_row_px);
    const std::vector<Row> rows = shown_rows(diagnosis, std::clamp(held, rows_least, rows_most));
    DrawnRows drawn;
    for (const Row& row : rows) {
        drawn.domains.insert(drawn.domains.end(), row.domains.begin(), row.domains.end());
    }
    const auto most = static_cast<std::size_t>(paper.columns_up_to(diagnosed_columns_most));
    const std::size_t axes = axes_in(diagnosis);
    const bool by_axis = axes > 1 && axes <= most && rows.front().domains.size() == axes;
    drawn.columns = by_axis ? axes : std::clamp(drawn.domains.size(), std::size_t{1}, most);
    const std::size_t stacked_most = std::max(held, rows_least);
    if (drawn.columns == 1 && drawn.domains.size() > stacked_most) {
        std::ranges::stable_sort(drawn.domains, std::ranges::greater(), rank_of);
        drawn.domains.resize(stacked_most);
    }
    return drawn;
}

}  // namespace

Figure figure_of(const DiagnosisFigure& request) {
    const Diagnosis& diagnosis = request.diagnosis;
    Figure figure;
    figure.title = request.title;
    figure.source = diagnosis.recording_name + "  |  " + diagnosis.model_name;
    figure.facts = request.facts;
    figure.scale = request.paper.scale();
    double height_px = diagnosis_heading_px + diagnosis_key_px +
                       diagnosis_fact_line_px * static_cast<double>(request.facts.size());
    if (const std::optional<Panel> bars = share_bars(diagnosis)) {
        figure.panels.push_back(*bars);
        height_px += bars->height_share;
    }
    // With many causes the figure is higher.
    const double page_px = text_height_mm / mm_per_inch * dpi_of_scale_1;
    const DrawnRows rows = drawn_rows(diagnosis, request.paper, page_px - height_px);
    figure.columns = static_cast<int>(rows.columns);

    std::vector<DomainPanel> drawn;
    std::vector<Panel> panels;
    for (const GapDomain* domain : rows.domains) {
        drawn.emplace_back(*domain, diagnosis.band_probability);
        panels.push_back(drawn.back().panel());
        panels.back().height_share = rows.domains.size() == 1 ? lone_panel_px : domain_row_px;
    }
    share_titles(panels, rows.columns);
    for (std::size_t i = 0; i < panels.size(); i += rows.columns) { height_px += panels[i].height_share; }
    figure.panels.insert(figure.panels.end(), panels.begin(), panels.end());
    figure.key = key_of(drawn);
    figure.width_px = request.paper.width_px();
    figure.height_px = request.paper.scaled_pixels(std::max(height_px, lone_panel_px));
    return figure;
}

Rendering render(const DiagnosisFigure& diagnosis) { return render(figure_of(diagnosis)); }

}  // namespace gyrolog
