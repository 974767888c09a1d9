#include "analysis/plot/denoise_figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include "analysis/plot/number_text.hpp"

namespace gyrolog {
namespace {

constexpr double denoised_heading_px = 110.0;
constexpr double denoised_row_px = 300.0;
constexpr double denoised_row_least_px = 205.0;
constexpr double denoised_key_px = 86.0;  // in two lines
constexpr int denoised_columns_most = 3;
constexpr std::size_t denoised_rows_most = 6;
constexpr double shown_at_rest_s = 10.0;
constexpr double shown_in_motion_s = 5.0;
constexpr double shown_at_start_s = 3.0;
constexpr double lag_unit_s = 1e-3;

constexpr Colour unit_colour{170, 174, 180};

Colour colour_of(DenoiseMethod method) {
    switch (method) {
        case DenoiseMethod::kalman:
            return colours::blue;
        case DenoiseMethod::wavelet:
            return colours::green;
        case DenoiseMethod::joint:
            break;
    }
    return colours::vermillion;
}

const Stroke before_line{unit_colour, 1.4, {}};
Stroke line_of(DenoiseMethod method) { return {colour_of(method), 2.0, {}}; }
Stroke line_of_walk(Stroke stroke) {
    stroke.dash_px = {7.0, 5.0};
    return stroke;
}

// Of samples, which lie closer than the line is wide.
Stroke thinner(Stroke stroke) {
    stroke.width_px = 0.7 * stroke.width_px;
    return stroke;
}

class DenoisedAxisPanels {
public:
    DenoisedAxisPanels(const DenoiseFigure& figure, const AxisDenoising& axis)
        : figure_(figure), axis_(axis), units_(units_of(figure.recording, axis.knowledge.axis)) {}

    // Over time.
    Panel at_rest() const {
        Panel panel;
        panel.x = {"time (s)", ScaleKind::linear, {}};
        panel.y = {figure_.quantity + " (" + figure_.unit + ")", ScaleKind::linear, {}};
        panel.caption = caption("at rest, mean taken off");
        const double length_s = figure_.still.to_s - figure_.still.from_s;
        if (!(length_s > 0.0)) { return panel; }
        // Where filters have settled.
        const double from_s = figure_.still.from_s + std::max(0.0, 0.5 * (length_s - shown_at_rest_s));
        add_signals(panel, from_s, std::min(length_s, shown_at_rest_s),
                    [mean = on_paper(mean_at_rest())](std::size_t) { return mean; });
        return panel;
    }

    // Around the reference's largest rate.
    Panel in_motion() const {
        Panel panel;
        panel.x = {"time (s)", ScaleKind::linear, {}};
        panel.y = {"error (" + figure_.unit + ")", ScaleKind::linear, {}};
        panel.caption = caption("less the reference, in motion");
        const Column* reference = figure_.recording.find("ref_" + axis_.knowledge.axis);
        if (reference == nullptr || !axis_.unit_motion) {
            panel.y.title = figure_.quantity + " (" + figure_.unit + ")";
            panel.caption = caption("the first seconds");
            add_signals(panel, 0.0, shown_at_start_s, [](std::size_t) { return 0.0; });
            return panel;
        }
        std::size_t peak = 0;
        double largest = -1.0;
        for (std::size_t row = 0; row < reference->size(); ++row) {
            const double size = std::abs(reference->value(row));
            if (size > largest) {
                largest = size;
                peak = row;
            }
        }
        const double at_s = time_of(peak);
        const double from_s = std::max(0.0, at_s - 0.5 * shown_in_motion_s);
        add_signals(panel, from_s, shown_in_motion_s,
                    [&](std::size_t row) { return on_paper(reference->value(row)); });
        return panel;
    }

    Panel allan() const {
        Panel panel;
        panel.x = {"averaging time τ (s)", ScaleKind::logarithmic, {}};
        panel.y = {"σ(τ) (" + figure_.unit + ")", ScaleKind::logarithmic, {}};
        panel.caption = caption("Allan deviation at rest");
        for (const AllanCurve& unit : axis_.unit_allan) {
            panel.curves.push_back(deviations(unit, before_line));
        }
        for (const DenoisedSignal& signal : axis_.signals) {
            panel.curves.push_back(deviations(signal.allan, line_of(signal.design.method)));
        }
        return panel;
    }

    Panel density() const {
        Panel panel;
        panel.x = {"frequency (Hz)", ScaleKind::logarithmic, {}};
        panel.y = {"√S, two-sided ((" + figure_.unit + ")/√Hz)", ScaleKind::logarithmic, {}};
        panel.caption = caption("noise density at rest");
        for (const PowerSpectrum& unit : axis_.unit_spectra) {
            panel.curves.push_back(densities(unit, before_line));
        }
        for (const DenoisedSignal& signal : axis_.signals) {
            panel.curves.push_back(densities(signal.spectrum, line_of(signal.design.method)));
        }
        return panel;
    }

    // What the bandwidth costs and gains; the one in use is marked.
    Panel bandwidth(bool is_noise) const {
        Panel panel;
        panel.x = {"bandwidth of the rate (Hz)", ScaleKind::logarithmic, {}};
        if (is_noise) {
            panel.y = {"variance / one unit's", ScaleKind::logarithmic, {}};
            panel.caption = caption("white noise that is left");
        } else {
            panel.y = {"lag (ms)", ScaleKind::linear, {}};
            panel.caption = caption("lag in constant acceleration");
        }
        for (const DenoiseMethod method : {DenoiseMethod::kalman, DenoiseMethod::joint}) {
            add_bandwidths(panel, axis_.trend_curve, method, is_noise, line_of(method));
            add_bandwidths(panel, axis_.walk_curve, method, is_noise, line_of_walk(line_of(method)));
        }
        const RateDesign& rate = axis_.signals.front().design.rate;
        if (axis_.signals.front().design.method != DenoiseMethod::wavelet && rate.model != RateModel::free) {
            panel.guides.push_back({rate.bandwidth_hz, short_number(rate.bandwidth_hz) + " Hz"});
        }
        if (!is_noise) { panel.y.range = lag_range(panel); }
        return panel;
    }

    std::size_t units() const { return units_.size(); }

private:
    static std::vector<const Column*> units_of(const Recording& recording, const std::string& name) {
        for (const ArrayAxis& axis : array_axes(recording)) {
            if (axis.name == name) { return axis.units; }
        }
        return {};
    }

    double on_paper(double rate) const { return rate * figure_.per_column_unit; }
    std::string caption(const std::string& text) const { return axis_.knowledge.axis + ": " + text; }

    // Rows from `from_s` on, for `length_s`; breaks where samples are missing.
    template <typename Value>
    Curve series(double from_s, double length_s, const Value& value) const {
        Curve curve;
        const Recording& recording = figure_.recording;
        const std::int64_t origin = recording.segments.front().first_index;
        for (const Segment& segment :
             segments_within(recording.segments, recording.rate_hz, {from_s, from_s + length_s})) {
            if (!curve.x.empty()) {
                curve.x.push_back(curve.x.back());
                curve.y.push_back(std::nan(""));
            }
            for (std::size_t i = 0; i < segment.count; ++i) {
                const auto index = static_cast<double>(segment.first_index - origin) + static_cast<double>(i);
                curve.x.push_back(index / recording.rate_hz);
                curve.y.push_back(value(segment.first + i));
            }
        }
        return curve;
    }

    // So that none hides another.
    std::vector<const DenoisedSignal*> noisiest_first() const {
        std::vector<const DenoisedSignal*> signals;
        signals.reserve(axis_.signals.size());
        for (const DenoisedSignal& signal : axis_.signals) { signals.push_back(&signal); }
        std::ranges::stable_sort(signals, std::ranges::greater(), &DenoisedSignal::still_variance);
        return signals;
    }

    // `less(row)`, on paper, is taken from every signal.
    template <typename Less>
    void add_signals(Panel& panel, double from_s, double length_s, const Less& less) const {
        Curve before = series(from_s, length_s, [&](std::size_t row) {
            return on_paper(units_.front()->value(row)) - less(row);
        });
        before.stroke = thinner(before_line);
        panel.curves.push_back(std::move(before));
        for (const DenoisedSignal* drawn : noisiest_first()) {
            const DenoisedSignal& signal = *drawn;
            Curve after = series(from_s, length_s,
                                 [&](std::size_t row) { return on_paper(signal.rate[row]) - less(row); });
            after.stroke = thinner(line_of(signal.design.method));
            panel.curves.push_back(std::move(after));
        }
    }

    double mean_at_rest() const {
        double sum = 0.0;
        double count = 0.0;
        for (const Segment& segment :
             segments_within(figure_.recording.segments, figure_.recording.rate_hz, figure_.still)) {
            for (std::size_t i = segment.first; i < segment.first + segment.count; ++i) {
                sum += axis_.signals.front().rate[i];
                count += 1.0;
            }
        }
        return count > 0.0 ? sum / count : 0.0;
    }

    double time_of(std::size_t row) const {
        const Recording& recording = figure_.recording;
        for (const Segment& segment : recording.segments) {
            if (row >= segment.first && row < segment.first + segment.count) {
                return static_cast<double>(segment.first_index - recording.segments.front().first_index +
                                           static_cast<std::int64_t>(row - segment.first)) /
                       recording.rate_hz;
            }
        }
        return 0.0;
    }

    Curve deviations(const AllanCurve& allan, const Stroke& stroke) const {
        Curve curve;
        for (const AllanPoint& point : allan.points) {
            curve.x.push_back(point.tau_s);
            curve.y.push_back(on_paper(point.deviation));
        }
        curve.stroke = stroke;
        return curve;
    }

    Curve densities(const PowerSpectrum& spectrum, const Stroke& stroke) const {
        Curve curve;
        for (const SpectrumPoint& point : spectrum.points) {
            curve.x.push_back(point.f_hz);
            curve.y.push_back(on_paper(std::sqrt(point.density)));
        }
        curve.stroke = stroke;
        return curve;
    }

    static void add_bandwidths(Panel& panel, const std::vector<BandwidthPoint>& points, DenoiseMethod method,
                               bool is_noise, const Stroke& stroke) {
        Curve curve;
        for (const BandwidthPoint& point : points) {
            const FilterResponse& response = method == DenoiseMethod::kalman ? point.kalman : point.joint;
            curve.x.push_back(point.bandwidth_hz);
            curve.y.push_back(is_noise ? response.noise_ratio : response.lag_s / lag_unit_s);
        }
        curve.stroke = stroke;
        panel.curves.push_back(std::move(curve));
    }

    // A trend has no lag: its curve of rounding errors is not to fill the panel.
    static Range lag_range(const Panel& panel) {
        double highest = 1.0;
        for (const Curve& curve : panel.curves) {
            for (const double y : curve.y) { highest = std::max(highest, y); }
        }
        return {-0.05 * highest, 1.1 * highest};
    }

    const DenoiseFigure& figure_;
    const AxisDenoising& axis_;
    std::vector<const Column*> units_;
};

Curve key_line(const Stroke& stroke, std::string name) {
    Curve curve;
    curve.stroke = stroke;
    curve.legend = {std::move(name)};
    return curve;
}

// One for all panels. The bandwidths are those of two methods, whether both were used or not.
std::vector<Curve> key_of(const DenoiseFigure& denoise, std::size_t units, bool shows_bandwidths) {
    std::vector<Curve> key{key_line(before_line, units > 1 ? "before: a unit" : "before")};
    std::vector<DenoiseMethod> methods;
    for (const DenoisedSignal& signal : denoise.axes.front().signals) {
        methods.push_back(signal.design.method);
    }
    if (shows_bandwidths) {
        for (const DenoiseMethod method : {DenoiseMethod::kalman, DenoiseMethod::joint}) {
            if (std::ranges::count(methods, method) == 0) { methods.push_back(method); }
        }
    }
    for (const DenoiseMethod method : methods) {
        key.push_back(key_line(line_of(method), std::string(name_of(method))));
    }
    if (shows_bandwidths) {
        const Stroke of_any{colours::muted_ink, 2.0, {}};
        key.push_back(key_line(of_any, "rate model trend"));
        key.push_back(key_line(line_of_walk(of_any), "rate model walk"));
    }
    return key;
}

}  // namespace

// A kind a row, an axis a column. What a bandwidth gains is nearly the same on all axes: it is shown for the
// first one. On narrow paper, where an axis has no column of its own, the kinds that matter least are left
// out, so that the figure stays on a page.
Figure figure_of(const DenoiseFigure& denoise) {
    Figure figure;
    figure.title = "Denoising";
    figure.source = denoise.recording.name;
    figure.facts = denoise.facts;
    std::vector<DenoisedAxisPanels> axes;
    for (const AxisDenoising& axis : denoise.axes) { axes.emplace_back(denoise, axis); }
    const bool is_one = axes.size() == 1;
    figure.columns = denoise.paper.columns_up_to(
        is_one ? 2 : std::min(static_cast<int>(axes.size()), denoised_columns_most));
    const auto columns = static_cast<std::size_t>(figure.columns);
    const auto rows_of = [&](std::size_t panels) { return (panels + columns - 1) / columns; };
    bool shows_bandwidths = false;
    for (Panel (DenoisedAxisPanels::*kind)() const :
         {&DenoisedAxisPanels::at_rest, &DenoisedAxisPanels::allan, &DenoisedAxisPanels::density,
          &DenoisedAxisPanels::in_motion}) {
        if (rows_of(figure.panels.size() + axes.size()) > denoised_rows_most) { break; }
        for (const DenoisedAxisPanels& axis : axes) { figure.panels.push_back((axis.*kind)()); }
    }
    if (!axes.empty() && rows_of(figure.panels.size() + 2) <= denoised_rows_most) {
        shows_bandwidths = true;
        figure.panels.push_back(axes.front().bandwidth(true));
        figure.panels.push_back(axes.front().bandwidth(false));
    }
    if (!axes.empty()) { figure.key = key_of(denoise, axes.front().units(), shows_bandwidths); }
    share_titles(figure.panels, columns);
    figure.width_px = denoise.paper.width_px();
    figure.scale = denoise.paper.scale();
    const auto rows = static_cast<double>(std::max(rows_of(figure.panels.size()), std::size_t{1}));
    const double page_px = text_height_mm / mm_per_inch * dpi_of_scale_1;
    const double other_px = denoised_heading_px + denoised_key_px;
    const double row_px = std::clamp((page_px - other_px) / rows, denoised_row_least_px, denoised_row_px);
    figure.height_px = denoise.paper.scaled_pixels(other_px + row_px * rows);
    return figure;
}

Rendering render(const DenoiseFigure& denoise) { return render(figure_of(denoise)); }

}  // namespace gyrolog
