#include "analysis/spectrum/line_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "analysis/numerics/distributions.hpp"
#include "analysis/spectrum/gamma_ratio.hpp"

namespace gyrolog {
namespace {

using std::numbers::pi;

// A steady line fills the taper's four bins; one that drifts fills more.
constexpr std::array<std::size_t, 4> widths{1, 4, 16, 64};
// A line has at least so many periods in a piece, per bin of its width; what is broader is no line.
constexpr std::size_t periods_per_bin = 16;
// Between a line and the bins that its floor is taken from.
constexpr std::size_t guard = 3;
constexpr std::size_t most_reference_bins = 64;  // on each side
// The floor of a sloping spectrum is even enough over this share of its frequency.
constexpr std::size_t reference_share = 4;

std::size_t reference_bins(std::size_t bin, std::size_t width) {
    return std::min(bin / reference_share, std::max(most_reference_bins, 2 * width));
}

struct Floor {
    double density = 0.0;
    double bins = 0.0;
};

double power_of(const LineCandidate& line) {
    double power = 0.0;
    for (std::size_t k = line.first; k < line.end; ++k) {
        power += (line.periodogram->density[k] - line.floor) * line.periodogram->width_hz();
    }
    return power;
}

// One periodogram while lines are being taken out of it.
class Field {
public:
    explicit Field(const AveragedPeriodogram& periodogram);

    struct Find {
        std::size_t first = 0;
        std::size_t end = 0;
        double log_probability = 0.0;
    };

    const AveragedPeriodogram& periodogram() const { return *periodogram_; }
    double places() const;
    // The least probable place between two frequencies that no line was taken from; nothing where all are
    // ordinary.
    std::optional<Find> least_probable(double lo_hz, double hi_hz) const;
    std::optional<Find> least_probable() const { return least_probable(0.0, periodogram_->rate_hz); }
    LineCandidate candidate(const Find& find) const;
    void take(const LineCandidate& line);

private:
    template <typename Visit>
    void for_each_place(Visit&& visit) const;
    double mean(std::size_t first, std::size_t end) const {
        return (total_[end] - total_[first]) / static_cast<double>(end - first);
    }
    Floor floor_beside(std::size_t first, std::size_t end) const;
    double shape_of(const Floor& floor, double evenness) const {
        return std::max(floor.bins * shape_per_bin_ * evenness, 1.0);
    }
    double log_probability(std::size_t width_index, double evenness, double reference_shape,
                           double ratio) const;
    void mask_outliers();
    void sum_up();

    const AveragedPeriodogram* periodogram_;
    double shape_per_bin_ = 0.0;
    std::vector<char> outlier_;                       // not used for a floor
    std::vector<char> taken_;                         // belongs to a line
    std::vector<double> total_, clean_, clean_bins_;  // sums up to a bin; clean: without outliers and lines
    std::vector<std::size_t> taken_before_;
    std::array<std::vector<GammaPart>, widths.size()> parts_;
};

Field::Field(const AveragedPeriodogram& periodogram)
    : periodogram_(&periodogram),
      outlier_(periodogram.valid_end, 0),
      taken_(periodogram.valid_end, 0),
      total_(periodogram.valid_end + 1, 0.0) {
    constexpr std::size_t many = 64;
    shape_per_bin_ = periodogram.degrees_of_freedom(many) / 2.0 / many;
    std::partial_sum(periodogram.density.begin(), periodogram.density.end(), total_.begin() + 1);
    for (std::size_t i = 0; i < widths.size(); ++i) { parts_[i] = mean_of_bins(periodogram, widths[i]); }
    mask_outliers();
    sum_up();
}

// Bins that one in ten thousand exceeds by chance: other lines would raise the floor and hide this one.
// Leaves the mean of what remains where it was, to that measure.
void Field::mask_outliers() {
    constexpr double chance = 1e-4;
    constexpr std::size_t least_median_of = 16;
    const AveragedPeriodogram& p = *periodogram_;
    const double shape = p.degrees_of_freedom(1) / 2.0;
    const double limit =
        gamma_upper_quantile(shape, 1.0 / shape, chance) / gamma_quantile(shape, 1.0 / shape, 0.5);
    std::vector<double> around;
    for (std::size_t k = std::max(p.valid_begin, reference_share * least_median_of); k < p.valid_end;) {
        const std::size_t reach = reference_bins(k, 1);
        const std::size_t step = std::max<std::size_t>(reach / 4, 1);
        const std::size_t first = std::max(k - reach, p.valid_begin);
        const std::size_t end = std::min(k + reach + step, p.valid_end);
        around.assign(p.density.begin() + static_cast<std::ptrdiff_t>(first),
                      p.density.begin() + static_cast<std::ptrdiff_t>(end));
        const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
        std::ranges::nth_element(around, middle);
        for (std::size_t i = k; i < std::min(k + step, p.valid_end); ++i) {
            outlier_[i] = p.density[i] > limit * *middle ? 1 : 0;
        }
        k += step;
    }
}

void Field::sum_up() {
    const AveragedPeriodogram& p = *periodogram_;
    clean_.assign(p.valid_end + 1, 0.0);
    clean_bins_.assign(p.valid_end + 1, 0.0);
    taken_before_.assign(p.valid_end + 1, 0);
    for (std::size_t k = 0; k < p.valid_end; ++k) {
        const bool clean = k >= p.valid_begin && outlier_[k] == 0 && taken_[k] == 0;
        clean_[k + 1] = clean_[k] + (clean ? p.density[k] : 0.0);
        clean_bins_[k + 1] = clean_bins_[k] + (clean ? 1.0 : 0.0);
        taken_before_[k + 1] = taken_before_[k] + (taken_[k] != 0 ? 1U : 0U);
    }
}

template <typename Visit>
void Field::for_each_place(Visit&& visit) const {
    const AveragedPeriodogram& p = *periodogram_;
    const std::size_t nyquist = p.length / 2;
    for (std::size_t i = 0; i < widths.size(); ++i) {
        const std::size_t width = widths[i];
        const std::size_t margin = periods_per_bin * width;
        const std::size_t end = std::min(p.end, nyquist - std::min(nyquist, periods_per_bin));
        const std::size_t step = std::max<std::size_t>(width / 2, 1);
        for (std::size_t first = std::max(p.begin, margin); first + width <= end; first += step) {
            visit(i, first, first + width);
        }
    }
}

double Field::places() const {
    double count = 0.0;
    for_each_place([&](std::size_t, std::size_t, std::size_t) { ++count; });
    return count;
}

// Mean of both sides' means, so that a slope cancels; of all bins where one side has hardly any.
Floor Field::floor_beside(std::size_t first, std::size_t end) const {
    const AveragedPeriodogram& p = *periodogram_;
    const std::size_t reach = reference_bins((first + end) / 2, end - first);
    const auto side = [&](std::size_t from, std::size_t to) {
        return Floor{clean_[to] - clean_[from], clean_bins_[to] - clean_bins_[from]};
    };
    const std::size_t left_end = std::max(first - std::min(first, guard), p.valid_begin);
    const std::size_t left_first = std::max(left_end - std::min(left_end, reach), p.valid_begin);
    const std::size_t right_first = std::min(end + guard, p.valid_end);
    const Floor left = side(left_first, left_end);
    const Floor right = side(right_first, std::min(right_first + reach, p.valid_end));
    const double bins = left.bins + right.bins;
    if (bins <= 0.0) { return {}; }
    const double few = 0.25 * static_cast<double>(reach);
    if (left.bins <= few || right.bins <= few) { return {(left.density + right.density) / bins, bins}; }
    // As many equally weighted bins would give this variance.
    return {0.5 * (left.density / left.bins + right.density / right.bins),
            4.0 / (1.0 / left.bins + 1.0 / right.bins)};
}

// Uneven noise is as if there were fewer pieces, and less than one: bins that move together.
double Field::log_probability(std::size_t width_index, double evenness, double reference_shape,
                              double ratio) const {
    if (evenness == 1.0) { return log_tail_of_ratio(parts_[width_index], reference_shape, ratio); }
    const double even_shape = periodogram_->degrees_of_freedom(widths[width_index]) / 2.0;
    const double shape = std::max(even_shape * evenness, std::min(even_shape, 1.0));
    const std::array<GammaPart, 1> part{{{1.0 / shape, shape}}};
    return log_tail_of_ratio(part, reference_shape, ratio);
}

std::optional<Field::Find> Field::least_probable(double lo_hz, double hi_hz) const {
    constexpr double worth_a_look = 3.0;  // standard deviations
    std::optional<Find> best;
    std::array<double, widths.size()> limit{};
    // No place is less probable than one of its width with a larger ratio to a better known floor.
    std::array<double, widths.size()> best_ratio{}, best_shape{};
    for (std::size_t i = 0; i < widths.size(); ++i) {
        limit[i] = 1.0 + worth_a_look * std::sqrt(2.0 / periodogram_->degrees_of_freedom(widths[i]));
    }
    for_each_place([&](std::size_t i, std::size_t first, std::size_t end) {
        if (taken_before_[end] != taken_before_[first]) { return; }
        if (periodogram_->f_hz(end) <= lo_hz || periodogram_->f_hz(first) >= hi_hz) { return; }
        const Floor floor = floor_beside(first, end);
        if (floor.density <= 0.0) { return; }
        const double ratio = mean(first, end) / floor.density;
        const double evenness = periodogram_->evenness_at(first);
        const double shape = shape_of(floor, evenness);
        if (ratio < limit[i]) { return; }
        if (evenness == 1.0 && ratio <= best_ratio[i] && shape <= best_shape[i]) { return; }
        const double probability = log_probability(i, evenness, shape, ratio);
        if (evenness == 1.0 && ratio > best_ratio[i]) {
            best_ratio[i] = ratio;
            best_shape[i] = shape;
        }
        if (!best || probability < best->log_probability) { best = Find{first, end, probability}; }
    });
    return best;
}

// Grows the place over the bins beside it that are above the floor as well.
LineCandidate Field::candidate(const Find& find) const {
    const AveragedPeriodogram& p = *periodogram_;
    const Floor floor = floor_beside(find.first, find.end);
    LineCandidate line{&p,
                       find.first,
                       find.end,
                       floor.density,
                       shape_of(floor, p.evenness_at(find.first)),
                       find.log_probability};
    const std::size_t step = std::max<std::size_t>((find.end - find.first) / 4, 1);
    const std::size_t reach = reference_bins((find.first + find.end) / 2, find.end - find.first);
    const double limit = floor.density * (1.0 + 2.0 * std::sqrt(2.0 / p.degrees_of_freedom(step)));
    const std::size_t lowest = std::max(find.first - std::min(find.first, reach), p.valid_begin);
    const std::size_t highest = std::min(find.end + reach, p.valid_end);
    while (line.first >= lowest + step && mean(line.first - step, line.first) > limit) { line.first -= step; }
    while (line.end + step <= highest && mean(line.end, line.end + step) > limit) { line.end += step; }
    return line;
}

// A line's bins, and those beside it where the taper's side lobes hold more of it than the floor: d bins away
// they are below 1 / (pi d^3) of its amplitude.
void Field::take(const LineCandidate& line) {
    const double width_hz = periodogram_->width_hz();
    const double peak = power_of(line) / (width_hz * line.floor);
    const double reach = std::max(2.0, std::ceil(std::pow(std::max(peak, 0.0) / (pi * pi), 1.0 / 6.0)));
    const double first = std::floor(line.lo_hz() / width_hz) - reach;
    const double end = std::ceil(line.hi_hz() / width_hz) + reach + 1.0;
    const auto bins = static_cast<double>(taken_.size());
    for (auto k = static_cast<std::size_t>(std::clamp(first, 0.0, bins));
         k < static_cast<std::size_t>(std::clamp(end, 0.0, bins)); ++k) {
        taken_[k] = 1;
    }
    sum_up();
}

// The same line where it is narrowest. Many short pieces make a strong line least probable, few long ones
// tell where it is; but of a line that drifts they hold splinters.
LineCandidate narrowed(const LineCandidate& line, std::span<const Field> fields) {
    constexpr double enough_of_the_power = 0.7;
    LineCandidate finest = line;
    for (const Field& field : fields) {
        if (field.periodogram().width_hz() >= finest.periodogram->width_hz()) { continue; }
        const auto find = field.least_probable(line.lo_hz(), line.hi_hz());
        if (!find) { continue; }
        LineCandidate finer = field.candidate(*find);
        finer.log_false_alarm = line.log_false_alarm;
        if (power_of(finer) > enough_of_the_power * power_of(line)) { finest = finer; }
    }
    return finest;
}

// Whether they are apart by no more than the wider one's width.
bool belong_together(const LineCandidate& a, const LineCandidate& b) {
    const double width_hz = std::max(a.hi_hz() - a.lo_hz(), b.hi_hz() - b.lo_hz());
    return a.lo_hz() <= b.hi_hz() + width_hz && b.lo_hz() <= a.hi_hz() + width_hz;
}

}  // namespace

std::vector<LineCandidate> search_lines(std::span<const AveragedPeriodogram> periodograms, double false_alarm,
                                        std::size_t most) {
    std::vector<Field> fields(periodograms.begin(), periodograms.end());
    double places = 0.0;
    for (const Field& field : fields) { places += field.places(); }
    std::vector<std::optional<Field::Find>> finds(fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) { finds[i] = fields[i].least_probable(); }

    std::vector<LineCandidate> lines;
    // Power that is found beside a line is taken away too, a bounded number of times.
    for (std::size_t round = 0; round < 8 * most && lines.size() < most; ++round) {
        std::size_t best = fields.size();
        for (std::size_t i = 0; i < fields.size(); ++i) {
            if (finds[i] &&
                (best == fields.size() || finds[i]->log_probability < finds[best]->log_probability)) {
                best = i;
            }
        }
        if (best == fields.size()) { break; }
        LineCandidate line = fields[best].candidate(*finds[best]);
        line.log_false_alarm = std::min(0.0, line.log_false_alarm + std::log(places));
        if (line.log_false_alarm > std::log(false_alarm)) { break; }
        line = narrowed(line, fields);
        const bool is_new = std::ranges::none_of(
            lines, [&](const LineCandidate& other) { return belong_together(line, other); });
        if (is_new) { lines.push_back(line); }
        for (std::size_t i = 0; i < fields.size(); ++i) {
            fields[i].take(line);
            finds[i] = fields[i].least_probable();
        }
    }
    return lines;
}

}  // namespace gyrolog
