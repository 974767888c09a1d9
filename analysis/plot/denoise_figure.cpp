#include "analysis/plot/denoise_figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "analysis/plot/number_text.hpp"

namespace gyrolog {
namespace {

constexpr int denoised_heading_px = 110;
constexpr int denoised_row_px = 320;
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

class DenoisedAxisPanels {
public:
    DenoisedAxisPanels(const DenoiseFigure& figure, const AxisDenoising& axis)
        : figure_(figure), axis_(axis), units_(units_of(figure.recording, axis.knowledge.axis)) {}

    void add_to(Figure& figure) const {
        figure.panels.push_back(at_rest());
        figure.panels.push_back(in_motion());
        figure.panels.push_back(allan());
        figure.panels.push_back(density());
        figure.panels.push_back(bandwidth(true));
        figure.panels.push_back(bandwidth(false));
    }

private:
    static std::vector<const Column*> units_of(const Recording& recording, const std::string& name) {
        for (const ArrayAxis& axis : array_axes(recording)) {
            if (axis.name == name) { return axis.units; }
        }
        return {};
    }

    double on_paper(double rate) const { return rate * figure_.per_column_unit; }
    std::string one_unit() const { return units_.size() > 1 ? "unit 1" : "the unit"; }
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
        before.stroke = {unit_colour, 1.2, {}};
        panel.curves.push_back(std::move(before));
        for (const DenoisedSignal* drawn : noisiest_first()) {
            const DenoisedSignal& signal = *drawn;
            Curve after = series(from_s, length_s,
                                 [&](std::size_t row) { return on_paper(signal.rate[row]) - less(row); });
            after.stroke = {colour_of(signal.design.method), 1.8, {}};
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

    Panel at_rest() const {
        Panel panel;
        panel.x = {"time (s)", ScaleKind::linear, {}};
        panel.y = {figure_.quantity + " (" + figure_.unit + ")", ScaleKind::linear, {}};
        panel.caption = caption(one_unit() + " and what came out, at rest");
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
        panel.caption = caption("less the reference, around its largest rate");
        const Column* reference = figure_.recording.find("ref_" + axis_.knowledge.axis);
        if (reference == nullptr || !axis_.unit_motion) {
            panel.y.title = figure_.quantity + " (" + figure_.unit + ")";
            panel.caption = caption("the beginning: filters that know nothing yet");
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

    Curve deviations(const AllanCurve& allan, const Stroke& stroke, const std::string& name) const {
        Curve curve;
        for (const AllanPoint& point : allan.points) {
            curve.x.push_back(point.tau_s);
            curve.y.push_back(on_paper(point.deviation));
        }
        curve.stroke = stroke;
        if (!name.empty()) { curve.legend = {name}; }
        return curve;
    }

    Curve densities(const PowerSpectrum& spectrum, const Stroke& stroke, const std::string& name) const {
        Curve curve;
        for (const SpectrumPoint& point : spectrum.points) {
            curve.x.push_back(point.f_hz);
            curve.y.push_back(on_paper(std::sqrt(point.density)));
        }
        curve.stroke = stroke;
        if (!name.empty()) { curve.legend = {name}; }
        return curve;
    }

    std::string units_name(std::size_t i) const {
        if (i > 0) { return ""; }
        return units_.size() > 1 ? "units" : "before";
    }

    Panel allan() const {
        Panel panel;
        panel.x = {"averaging time τ (s)", ScaleKind::logarithmic, {}};
        panel.y = {"σ(τ) (" + figure_.unit + ")", ScaleKind::logarithmic, {}};
        panel.caption = caption("Allan deviation at rest");
        for (std::size_t i = 0; i < axis_.unit_allan.size(); ++i) {
            panel.curves.push_back(deviations(axis_.unit_allan[i], {unit_colour, 1.4, {}}, units_name(i)));
        }
        for (const DenoisedSignal& signal : axis_.signals) {
            panel.curves.push_back(deviations(signal.allan, {colour_of(signal.design.method), 2.2, {}},
                                              std::string(name_of(signal.design.method))));
        }
        return panel;
    }

    Panel density() const {
        Panel panel;
        panel.x = {"frequency (Hz)", ScaleKind::logarithmic, {}};
        panel.y = {"√S, two-sided ((" + figure_.unit + ")/√Hz)", ScaleKind::logarithmic, {}};
        panel.caption = caption("noise density at rest");
        for (std::size_t i = 0; i < axis_.unit_spectra.size(); ++i) {
            panel.curves.push_back(densities(axis_.unit_spectra[i], {unit_colour, 1.4, {}}, units_name(i)));
        }
        for (const DenoisedSignal& signal : axis_.signals) {
            panel.curves.push_back(densities(signal.spectrum, {colour_of(signal.design.method), 2.0, {}},
                                             std::string(name_of(signal.design.method))));
        }
        return panel;
    }

    static void add_bandwidths(Panel& panel, const std::vector<BandwidthPoint>& points, DenoiseMethod method,
                               bool is_noise, const std::string& model) {
        Curve curve;
        for (const BandwidthPoint& point : points) {
            const FilterResponse& response = method == DenoiseMethod::kalman ? point.kalman : point.joint;
            curve.x.push_back(point.bandwidth_hz);
            curve.y.push_back(is_noise ? response.noise_ratio : response.lag_s / lag_unit_s);
        }
        curve.stroke = {colour_of(method), 2.2, {}};
        if (model == "walk") { curve.stroke.dash_px = {7.0, 5.0}; }
        curve.legend = {std::string(name_of(method)) + ", " + model};
        panel.curves.push_back(std::move(curve));
    }

    // What the bandwidth costs and gains; the one in use is marked.
    Panel bandwidth(bool is_noise) const {
        Panel panel;
        panel.x = {"bandwidth of the rate (Hz)", ScaleKind::logarithmic, {}};
        if (is_noise) {
            panel.y = {"variance / one unit's", ScaleKind::logarithmic, {}};
            panel.caption = caption("white noise left, by bandwidth");
        } else {
            panel.y = {"lag (ms)", ScaleKind::linear, {}};
            panel.caption = caption("lag at constant acceleration, by bandwidth");
        }
        for (const DenoiseMethod method : {DenoiseMethod::kalman, DenoiseMethod::joint}) {
            add_bandwidths(panel, axis_.trend_curve, method, is_noise, "trend");
            add_bandwidths(panel, axis_.walk_curve, method, is_noise, "walk");
        }
        const RateDesign& rate = axis_.signals.front().design.rate;
        if (axis_.signals.front().design.method != DenoiseMethod::wavelet && rate.model != RateModel::free) {
            panel.guides.push_back({rate.bandwidth_hz, rounded_number(rate.bandwidth_hz, 3) + " Hz"});
        }
        if (!is_noise) { panel.y.range = lag_range(panel); }
        return panel;
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

}  // namespace

Figure figure_of(const DenoiseFigure& denoise) {
    Figure figure;
    figure.title = "Denoising";
    figure.source = denoise.recording.name;
    figure.facts = denoise.facts;
    figure.columns = denoise.paper.columns_up_to(2);
    for (const AxisDenoising& axis : denoise.axes) { DenoisedAxisPanels(denoise, axis).add_to(figure); }
    figure.width_px = denoise.paper.width_px();
    figure.scale = denoise.paper.scale();
    const auto columns = static_cast<std::size_t>(figure.columns);
    const auto rows = static_cast<int>((figure.panels.size() + columns - 1) / columns);
    figure.height_px = denoise.paper.scaled_pixels(denoised_heading_px + denoised_row_px * rows);
    return figure;
}

Rendering render(const DenoiseFigure& denoise) { return render(figure_of(denoise)); }

}  // namespace gyrolog
