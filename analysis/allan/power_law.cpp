#include "analysis/allan/power_law.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gyrolog {
namespace {

std::vector<double> differences(std::span<const double> x) {
    std::vector<double> d;
    for (std::size_t i = 1; i < x.size(); ++i) { d.push_back(x[i] - x[i - 1]); }
    return d;
}

struct Spread {
    double mean = 0.0;
    double squares = 0.0;     // sum of squared deviations from the mean
    double neighbours = 0.0;  // sum of products of neighbouring deviations
    std::size_t count = 0;
};

Spread spread_of(std::span<const double> x) {
    Spread spread;
    for (const double value : x) {
        if (std::isnan(value)) { continue; }
        spread.mean += value;
        ++spread.count;
    }
    if (spread.count == 0) { return spread; }
    spread.mean /= static_cast<double>(spread.count);
    double before = std::nan("");
    for (const double value : x) {
        const double off = value - spread.mean;
        if (!std::isnan(off)) { spread.squares += off * off; }
        if (!std::isnan(off * before)) { spread.neighbours += off * before; }
        before = off;
    }
    return spread;
}

// The exponent alpha of the rate's spectrum f^alpha.
std::optional<double> exponent_by_autocorrelation(std::span<const double> averages) {
    std::vector<double> x(averages.begin(), averages.end());
    for (int order = 0;; ++order) {
        const Spread spread = spread_of(x);
        if (spread.squares <= 0.0) { return std::nullopt; }
        const double r = spread.neighbours / spread.squares;
        const double delta = r / (1.0 + r);
        if (delta < 0.25 || order == 1) { return -2.0 * (delta + order); }
        x = differences(x);
    }
}

// B1: expected ratio of the sample variance of n averages to their Allan variance (Barnes 1969).
double b1(double n, PowerLaw law) {
    switch (law) {
        case PowerLaw::white_angle:
        case PowerLaw::flicker_angle:
            return (n + 1.0) / (1.5 * n);
        case PowerLaw::white_rate:
            return 1.0;
        case PowerLaw::flicker_rate:
            return n * std::log(n) / (2.0 * (n - 1.0) * std::log(2.0));
        case PowerLaw::rate_walk:
            return n / 2.0;
    }
    return 1.0;
}

std::optional<PowerLaw> law_by_b1(std::span<const double> averages) {
    const Spread spread = spread_of(averages);
    double squares = 0.0;
    std::size_t pairs = 0;
    for (const double d : differences(averages)) {
        if (std::isnan(d)) { continue; }
        squares += d * d;
        ++pairs;
    }
    if (pairs < 2 || squares <= 0.0) { return std::nullopt; }
    const auto n = static_cast<double>(spread.count);
    const double ratio = spread.squares / (n - 1.0) / (squares / (2.0 * static_cast<double>(pairs)));
    // White and flicker angle have one B1; the first is by far the commoner, and the interval hardly differs.
    constexpr std::array laws = {PowerLaw::white_angle, PowerLaw::white_rate, PowerLaw::flicker_rate,
                                 PowerLaw::rate_walk};
    for (std::size_t i = 0; i + 1 < laws.size(); ++i) {
        if (ratio < std::sqrt(b1(n, laws[i]) * b1(n, laws[i + 1]))) { return laws[i]; }
    }
    return PowerLaw::rate_walk;
}

}  // namespace

std::optional<PowerLaw> identify_power_law(std::span<const double> averages) {
    const auto count = std::ranges::count_if(averages, [](double x) { return !std::isnan(x); });
    if (count < 4) { return std::nullopt; }
    if (count < 30) { return law_by_b1(averages); }
    const std::optional<double> alpha = exponent_by_autocorrelation(averages);
    if (!alpha) { return std::nullopt; }
    return static_cast<PowerLaw>(std::lround(2.0 - std::clamp(*alpha, -2.0, 2.0)));
}

}  // namespace gyrolog
