#include "analysis/denoise/unit_watch.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {
namespace {

constexpr std::array<std::string_view, unit_states> state_names{"good", "missing", "stuck", "saturated",
                                                                "noisy"};
constexpr double far_off = 8.0;
constexpr double noisy_above = 4.0;
constexpr double good_below = 2.0;
constexpr double memory_samples = 128.0;
constexpr double scale_tolerance = 0.03;
constexpr std::size_t units_to_tell = 3;
constexpr std::size_t repeats_least = 8;
// Asymptotic variance of a median over that of a mean.
constexpr double median_variance = 1.5707963267948966;

}  // namespace

std::string_view name_of(UnitState state) { return state_names.at(static_cast<std::size_t>(state)); }

std::size_t repeats_allowed(double repeat_share) {
    constexpr double rare = 1e-12;
    constexpr double always = 0.999;
    if (repeat_share >= always) { return std::numeric_limits<std::size_t>::max(); }
    if (!(repeat_share > 0.0)) { return repeats_least; }
    return std::max(repeats_least,
                    static_cast<std::size_t>(std::ceil(std::log(rare) / std::log(repeat_share))));
}

UnitWatch::UnitWatch(std::span<const UnitLimits> limits) {
    units_.reserve(limits.size());
    for (const UnitLimits& limit : limits) { units_.push_back({.limits = limit}); }
}

void UnitWatch::judge_alone(std::size_t i, double rate) {
    Unit& unit = units_[i];
    UnitState& state = states_.at(i);
    state = UnitState::good;
    if (std::isnan(rate)) {
        state = UnitState::missing;
        unit.run = 0;
        unit.last = rate;
        return;
    }
    unit.run = rate == unit.last ? unit.run + 1 : 1;
    unit.last = rate;
    if (std::abs(rate) >= unit.limits.saturation) {
        state = UnitState::saturated;
    } else if (unit.run > unit.limits.repeats_most) {
        state = UnitState::stuck;
    }
}

// What the units that are not noisy say, less their offsets; of all that could work where those are too few.
UnitWatch::Reference UnitWatch::reference(std::span<const double> rates, std::span<const double> offsets) {
    for (const bool all : {false, true}) {
        Reference found;
        double information = 0.0;
        for (std::size_t i = 0; i < rates.size(); ++i) {
            if (states_.at(i) != UnitState::good || (!all && units_[i].noisy)) { continue; }
            sorted_.at(found.units++) = rates[i] - offsets[i];
            information += 1.0 / (units_[i].limits.white_sd * units_[i].limits.white_sd);
        }
        if (found.units + (all ? 0U : 1U) < units_to_tell) { continue; }
        const auto end = sorted_.begin() + static_cast<std::ptrdiff_t>(found.units);
        std::sort(sorted_.begin(), end);
        found.median = 0.5 * (sorted_.at((found.units - 1) / 2) + sorted_.at(found.units / 2));
        found.variance = median_variance / information;
        // Two that work tell of a third whether it is quiet again, but not of each other.
        found.tells_of_good = !all && found.units >= units_to_tell;
        return found;
    }
    return {};
}

void UnitWatch::judge_distances(std::span<const double> rates, std::span<const double> offsets) {
    const Reference others = reference(rates, offsets);
    const double turning = scale_tolerance * others.median;
    for (std::size_t i = 0; i < rates.size(); ++i) {
        if (states_.at(i) != UnitState::good) { continue; }
        Unit& unit = units_[i];
        if (others.units == 0 || (!others.tells_of_good && !unit.noisy)) {
            if (unit.noisy) { states_.at(i) = UnitState::noisy; }
            continue;
        }
        const double variance =
            unit.limits.white_sd * unit.limits.white_sd + others.variance + turning * turning;
        const double distance = rates[i] - offsets[i] - others.median;
        const double square = distance * distance / variance;
        // One wild sample is no noise: it counts for as much as is left out at once.
        unit.mean_square += (std::min(square, far_off * far_off) - unit.mean_square) / memory_samples;
        unit.noisy = unit.mean_square > (unit.noisy ? good_below : noisy_above);
        if (unit.noisy || square > far_off * far_off) { states_.at(i) = UnitState::noisy; }
    }
}

std::span<const UnitState> UnitWatch::judge(std::span<const double> rates, std::span<const double> offsets,
                                            bool offsets_known) {
    for (std::size_t i = 0; i < rates.size(); ++i) { judge_alone(i, rates[i]); }
    if (offsets_known) { judge_distances(rates, offsets); }
    return std::span<const UnitState>(states_).first(rates.size());
}

}  // namespace gyrolog
