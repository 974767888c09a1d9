#include "analysis/plot/scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "analysis/plot/number_text.hpp"

namespace gyrolog {
namespace {

constexpr int minor_ticks_max = 120;
constexpr double largest_shown = 1e250;  // leaves room for margins and powers of ten inside a double

double power10(int exponent) { return std::pow(10.0, exponent); }

bool is_inside(double value, Range range) {
    const double slack = 1e-9 * (range.hi - range.lo);
    return value >= range.lo - slack && value <= range.hi + slack;
}

bool is_inside_log(double value, Range range) {
    return value > 0.0 && value >= range.lo * (1.0 - 1e-9) && value <= range.hi * (1.0 + 1e-9);
}

struct Step {
    int mantissa;  // 1, 2 or 5
    int exponent;
    double size() const { return mantissa * power10(exponent); }
};

Step finer(Step step) {
    if (step.mantissa == 5) { return {2, step.exponent}; }
    if (step.mantissa == 2) { return {1, step.exponent}; }
    return {5, step.exponent - 1};
}

double multiples_inside(Step step, Range range) {
    return std::floor(range.hi / step.size() + 1e-9) - std::ceil(range.lo / step.size() - 1e-9) + 1.0;
}

Step linear_step(Range range, int max_labels) {
    const int top = static_cast<int>(std::floor(std::log10(range.hi - range.lo))) + 1;
    Step step{5, top};
    while (multiples_inside(finer(step), range) <= max_labels) { step = finer(step); }
    return step;
}

// Powers of ten are taken out of the labels where the numbers would otherwise be long strings of noughts.
int common_exponent(Range range, Step step) {
    const double largest = std::max(std::fabs(range.lo), std::fabs(range.hi));
    const int exponent = static_cast<int>(std::floor(std::log10(largest)));
    return exponent >= 5 || step.exponent < -4 ? exponent : 0;
}

Ticks linear_ticks(Range range, int max_labels) {
    const Step step = linear_step(range, max_labels);
    Ticks result;
    result.exponent = common_exponent(range, step);
    const int decimals = std::max(0, result.exponent - step.exponent);
    const int minor_per_step = step.mantissa == 2 ? 4 : 5;
    const auto first = static_cast<std::int64_t>(std::floor(range.lo / step.size())) * minor_per_step;
    const auto last = static_cast<std::int64_t>(std::ceil(range.hi / step.size())) * minor_per_step;
    for (std::int64_t k = first; k <= last; ++k) {
        const double value = static_cast<double>(k) / minor_per_step * step.size();
        if (!is_inside(value, range)) { continue; }
        const bool is_major = k % minor_per_step == 0;
        const double shown = value / power10(result.exponent);
        result.ticks.push_back({value, is_major ? fixed_decimal(shown, decimals) : std::string()});
    }
    return result;
}

// Of a decade, those that have a label: ever fewer, and as evenly as a logarithm has them.
using Mantissas = std::span<const int>;
constexpr std::array powers_only{1};
constexpr std::array with_two_and_five{1, 2, 5};
constexpr std::array with_three{1, 3};

// Plain numbers where they are short and others stand among the powers of ten.
std::string decade_label(int mantissa, int exponent, bool is_plain) {
    if (is_plain) { return fixed_decimal(mantissa * power10(exponent), std::max(0, -exponent)); }
    if (mantissa == 1) { return power_of_ten(exponent); }
    return std::to_string(mantissa) + "×" + power_of_ten(exponent);
}

// Every power of ten whose exponent is a multiple of the stride gets a label, and the other mantissas in all
// decades.
Ticks decade_ticks(Range range, int stride, Mantissas mantissas) {
    Ticks result;
    const int first = static_cast<int>(std::floor(std::log10(range.lo)));
    const int last = static_cast<int>(std::ceil(std::log10(range.hi)));
    const bool is_plain = mantissas.size() > 1 && range.lo >= 1e-3 && range.hi < 2e4;
    const bool with_minor = stride == 1 && 9 * (last - first) <= minor_ticks_max;
    for (int exponent = first; exponent <= last; ++exponent) {
        for (int mantissa = 1; mantissa <= (with_minor ? 9 : 1); ++mantissa) {
            const double value = mantissa * power10(exponent);
            if (!is_inside_log(value, range)) { continue; }
            const bool labelled =
                mantissa == 1 ? exponent % stride == 0 : std::ranges::count(mantissas, mantissa) != 0;
            result.ticks.push_back(
                {value, labelled ? decade_label(mantissa, exponent, is_plain) : std::string()});
        }
    }
    return result;
}

int labels_in(const Ticks& ticks) {
    return static_cast<int>(std::count_if(ticks.ticks.begin(), ticks.ticks.end(),
                                          [](const Tick& tick) { return !tick.label.empty(); }));
}

// The linear steps of a short logarithmic range, each label complete in itself.
Ticks linear_ticks_on_log_scale(Range range, int max_labels) {
    Ticks result = linear_ticks(range, max_labels);
    if (result.exponent == 0) { return result; }
    for (Tick& tick : result.ticks) {
        if (!tick.label.empty()) { tick.label += "×" + power_of_ten(result.exponent); }
    }
    result.exponent = 0;
    return result;
}

Ticks logarithmic_ticks(Range range, int max_labels) {
    if (labels_in(decade_ticks(range, 1, powers_only)) < 3) {
        int most = 0;
        for (const Mantissas mantissas : {Mantissas(with_two_and_five), Mantissas(with_three)}) {
            Ticks fine = decade_ticks(range, 1, mantissas);
            if (labels_in(fine) >= 3 && labels_in(fine) <= max_labels) { return fine; }
            most = std::max(most, labels_in(fine));
        }
        if (most < 3) { return linear_ticks_on_log_scale(range, max_labels); }
    }
    constexpr std::array<int, 10> strides{1, 2, 3, 5, 10, 20, 50, 100, 200, 500};
    for (const int stride : strides) {
        Ticks coarse = decade_ticks(range, stride, powers_only);
        if (labels_in(coarse) <= max_labels) {
            return labels_in(coarse) >= 2 ? coarse : linear_ticks_on_log_scale(range, max_labels);
        }
    }
    return decade_ticks(range, 1000, powers_only);
}

bool keep_apart(const Ticks& ticks, const Scale& scale, double min_apart_px,
                const std::function<double(const std::string&)>& extent_px) {
    double previous_end = -std::numeric_limits<double>::infinity();
    const double direction = scale.pixel_hi > scale.pixel_lo ? 1.0 : -1.0;
    for (const Tick& tick : ticks.ticks) {
        if (tick.label.empty()) { continue; }
        const double centre = direction * scale.pixel(tick.value);
        const double half = extent_px(tick.label) / 2.0;
        if (centre - half < previous_end + min_apart_px) { return false; }
        previous_end = centre + half;
    }
    return true;
}

}  // namespace

bool can_scale(ScaleKind kind, Range range) {
    const double largest = std::max(std::fabs(range.lo), std::fabs(range.hi));
    if (!(largest <= 10.0 * largest_shown) || !(range.hi > range.lo)) { return false; }
    if (kind == ScaleKind::logarithmic) {
        return range.lo >= 0.1 / largest_shown && range.hi / range.lo > 1.0 + 1e-9;
    }
    return range.hi - range.lo > 1e-10 * largest && range.hi - range.lo > 0.1 / largest_shown;
}

double Scale::pixel(double value) const {
    if (!std::isfinite(value)) { return std::numeric_limits<double>::quiet_NaN(); }
    if (kind == ScaleKind::linear) {
        return pixel_lo + (value - range.lo) / (range.hi - range.lo) * (pixel_hi - pixel_lo);
    }
    if (value <= 0.0) { return std::numeric_limits<double>::quiet_NaN(); }
    const double share = std::log10(value / range.lo) / std::log10(range.hi / range.lo);
    return pixel_lo + share * (pixel_hi - pixel_lo);
}

double Scale::value(double pixel) const {
    const double share = (pixel - pixel_lo) / (pixel_hi - pixel_lo);
    if (kind == ScaleKind::linear) { return range.lo + share * (range.hi - range.lo); }
    return range.lo * std::pow(range.hi / range.lo, share);
}

Ticks find_ticks(ScaleKind kind, Range range, int max_labels) {
    return kind == ScaleKind::linear ? linear_ticks(range, max_labels) : logarithmic_ticks(range, max_labels);
}

Ticks fit_ticks(const Scale& scale, double min_apart_px,
                const std::function<double(const std::string&)>& extent_px) {
    for (int max_labels = 12; max_labels > 2; --max_labels) {
        Ticks ticks = find_ticks(scale.kind, scale.range, max_labels);
        if (keep_apart(ticks, scale, min_apart_px, extent_px)) { return ticks; }
    }
    return find_ticks(scale.kind, scale.range, 2);
}

void RangeFinder::add(double value) {
    if (!(std::fabs(value) <= largest_shown)) { return; }
    if (std::fabs(value) < 1.0 / largest_shown) { value = 0.0; }
    if (kind_ == ScaleKind::logarithmic && value <= 0.0) { return; }
    if (!found_) { found_ = Range{value, value}; }
    found_->lo = std::min(found_->lo, value);
    found_->hi = std::max(found_->hi, value);
}

Range RangeFinder::padded(double margin_share, double min_decades) const {
    const bool is_log = kind_ == ScaleKind::logarithmic;
    if (!found_) { return is_log ? Range{1.0, 10.0} : Range{0.0, 1.0}; }
    if (!is_log) {
        const double length = found_->hi - found_->lo;
        const double largest = std::max(std::fabs(found_->lo), std::fabs(found_->hi));
        const double of_one_value = largest == 0.0 ? 0.5 : 0.1 * largest;
        const double margin = length == 0.0 ? of_one_value : std::max(margin_share * length, 1e-9 * largest);
        return {found_->lo - margin, found_->hi + margin};
    }
    const double lo = std::log10(found_->lo);
    const double hi = std::log10(found_->hi);
    const double margin = std::max((hi - lo) * margin_share, (min_decades - (hi - lo)) / 2.0);
    return {std::pow(10.0, lo - margin), std::pow(10.0, hi + margin)};
}

}  // namespace gyrolog
