#include "analysis/spectrum/spectral_lines.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/spectrum/line_search.hpp"
#include "analysis/spectrum/sinusoid_fit.hpp"

namespace gyrolog {
namespace {

// Moments of the density above the floor.
struct Moments {
    double power = 0.0;            // under the line on the positive side: a quarter of its squared amplitude
    double power_sd = 0.0;         // of a line that is itself noise
    double steady_power_sd = 0.0;  // of a sinusoid in noise
    double f_hz = 0.0;
    double f_sd_hz = 0.0;
    double width_hz = 0.0;
};

Moments moments_of(const LineCandidate& line) {
    const AveragedPeriodogram& p = *line.periodogram;
    Moments m;
    double sum = 0.0;
    double first = 0.0;
    for (std::size_t k = line.first; k < line.end; ++k) {
        sum += p.density[k] - line.floor;
        first += (p.density[k] - line.floor) * p.f_hz(k);
    }
    m.power = sum * p.width_hz();
    m.f_hz = first / sum;
    double second = 0.0;
    double variance = 0.0;
    double steady_variance = 0.0;
    double f_variance = 0.0;
    for (std::size_t k = line.first; k < line.end; ++k) {
        const double excess = p.density[k] - line.floor;
        const double from_middle = p.f_hz(k) - m.f_hz;
        second += excess * from_middle * from_middle;
        variance += p.density[k] * p.density[k];
        steady_variance += line.floor * (2.0 * std::max(excess, 0.0) + line.floor);
        f_variance += std::pow(p.density[k] * from_middle, 2);
    }
    // Of one bin, with its share of the neighbours' correlation.
    const double relative_variance =
        2.0 / p.degrees_of_freedom(1) * (1.0 + 2.0 * (bin_correlation[1] + bin_correlation[2]));
    m.power_sd = std::sqrt(relative_variance * variance) * p.width_hz();
    m.steady_power_sd = std::sqrt(relative_variance * steady_variance) * p.width_hz();
    m.f_sd_hz = std::sqrt(relative_variance * f_variance) / sum;
    // The taper alone makes a sinusoid a third of a bin squared wide.
    const double own_width2 = second / sum - std::pow(p.width_hz(), 2) / 3.0;
    m.width_hz = std::sqrt(std::max(own_width2, 0.0));
    return m;
}

// About where the highest bin is, from it and its neighbours.
double peak_hz(const LineCandidate& line) {
    const AveragedPeriodogram& p = *line.periodogram;
    std::size_t peak = line.first;
    for (std::size_t k = line.first; k < line.end; ++k) {
        if (p.density[k] > p.density[peak]) { peak = k; }
    }
    double sum = 0.0;
    double first = 0.0;
    for (std::size_t k = peak - 1; k <= std::min(peak + 1, p.valid_end - 1); ++k) {
        const double excess = std::max(p.density[k] - line.floor, 0.0);
        sum += excess;
        first += excess * p.f_hz(k);
    }
    return first / sum;
}

SpectralLine estimate(const LineCandidate& candidate, const Column& column, std::span<const Segment> segments,
                      double rate_hz) {
    constexpr double allowed_loss = 0.05;
    constexpr double allowed_sd = 3.0;
    SpectralLine line;
    line.false_alarm = std::exp(candidate.log_false_alarm);
    const Moments m = moments_of(candidate);
    const double reach_hz = 0.75 * candidate.periodogram->width_hz();
    const auto fit = fit_sinusoid(column, segments, rate_hz, peak_hz(candidate), reach_hz, candidate.floor);
    // One phase for the whole record finds all of a steady line's power.
    const double found = fit ? fit->amplitude * fit->amplitude / 4.0 : 0.0;
    line.steady = found >= (1.0 - allowed_loss) * m.power - allowed_sd * m.steady_power_sd;
    if (line.steady && fit) {
        line.f_hz = fit->f_hz;
        line.f_sd_hz = fit->f_sd_hz;
        line.amplitude = fit->amplitude;
        line.amplitude_sd = fit->amplitude_sd;
    } else {
        line.f_hz = m.f_hz;
        line.f_sd_hz = m.f_sd_hz;
        line.amplitude = 2.0 * std::sqrt(m.power);
        line.amplitude_sd = m.power_sd / std::sqrt(m.power);
        line.width_hz = m.width_hz;
    }
    return line;
}

}  // namespace

std::vector<SpectralLine> find_lines(std::span<const AveragedPeriodogram> periodograms, const Column& column,
                                     std::span<const Segment> segments, double rate_hz, double false_alarm,
                                     std::size_t most) {
    std::vector<SpectralLine> lines;
    for (const LineCandidate& candidate : search_lines(periodograms, false_alarm, most)) {
        lines.push_back(estimate(candidate, column, segments, rate_hz));
    }
    std::ranges::sort(lines, std::ranges::greater(), &SpectralLine::amplitude);
    return lines;
}

std::vector<SpectralLine> find_lines(const Column& column, std::span<const Segment> segments, double rate_hz,
                                     double false_alarm, std::size_t most) {
    return find_lines(averaged_periodograms(column, segments, rate_hz), column, segments, rate_hz,
                      false_alarm, most);
}

}  // namespace gyrolog
