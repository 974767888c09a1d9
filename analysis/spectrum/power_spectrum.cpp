#include "analysis/spectrum/power_spectrum.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/allan/confidence.hpp"

namespace gyrolog {
namespace {

// Bins first ... end - 1 of a periodogram that fall into one band of the logarithmic axis.
struct Band {
    const AveragedPeriodogram* periodogram = nullptr;
    std::size_t first = 0;
    std::size_t end = 0;

    std::size_t bins() const { return end - first; }
    double dof() const {
        const double even = periodogram->degrees_of_freedom(bins());
        // All that an uneven record has may be one short stretch, but that is not nothing.
        return std::max(even * periodogram->evenness_at(first), std::min(even, 2.0));
    }
};

Band band_between(const AveragedPeriodogram& periodogram, double lo_hz, double hi_hz) {
    const auto bin_from = [&](double f_hz) {
        return static_cast<std::size_t>(std::ceil(f_hz / periodogram.width_hz()));
    };
    const std::size_t first = std::max(bin_from(lo_hz), periodogram.valid_begin);
    return {&periodogram, first, std::max(first, std::min(bin_from(hi_hz), periodogram.valid_end))};
}

// The one with most degrees of freedom among the periodograms that resolve the band, or else the finest. Four
// bins, as many as the taper makes of a line, keep most of a line in its band.
Band best_band(std::span<const AveragedPeriodogram> periodograms, double lo_hz, double hi_hz) {
    const double middle_hz = std::sqrt(lo_hz * hi_hz);
    Band best;
    for (const AveragedPeriodogram& periodogram : periodograms) {
        const bool covers = middle_hz >= periodogram.f_hz(periodogram.begin) - 0.5 * periodogram.width_hz() &&
                            middle_hz < periodogram.f_hz(periodogram.end);
        const Band band = band_between(periodogram, lo_hz, hi_hz);
        if (!covers || band.bins() == 0) { continue; }
        const bool resolves = 4.0 * periodogram.width_hz() <= hi_hz - lo_hz;
        if (best.periodogram == nullptr || !resolves || band.dof() > best.dof()) { best = band; }
    }
    return best;
}

SpectrumPoint point_of(const Band& band, double confidence) {
    const AveragedPeriodogram& periodogram = *band.periodogram;
    double sum = 0.0;
    for (std::size_t k = band.first; k < band.end; ++k) { sum += periodogram.density[k]; }
    SpectrumPoint point;
    const double half = 0.5 * periodogram.width_hz();
    point.f_hz = std::sqrt((periodogram.f_hz(band.first) - half) * (periodogram.f_hz(band.end - 1) + half));
    point.density = sum / static_cast<double>(band.bins());
    point.dof = band.dof();
    point.width_hz = static_cast<double>(band.bins()) * periodogram.width_hz();
    // The interval of a deviation, whose square is the density.
    const Interval deviation = chi_square_interval(std::sqrt(point.density), point.dof, confidence);
    point.lo = deviation.lo * deviation.lo;
    point.hi = deviation.hi * deviation.hi;
    return point;
}

}  // namespace

PowerSpectrum power_spectrum(std::span<const AveragedPeriodogram> periodograms,
                             const SpectrumOptions& options) {
    PowerSpectrum spectrum;
    spectrum.confidence = options.confidence;
    if (periodograms.empty()) { return spectrum; }
    double top_hz = 0.0;
    double bottom_hz = periodograms.front().rate_hz;
    for (const AveragedPeriodogram& periodogram : periodograms) {
        top_hz = std::max(top_hz, periodogram.rate_hz / 2.0);
        bottom_hz = std::min(bottom_hz, periodogram.f_hz(periodogram.begin));
    }
    const double step = std::pow(10.0, -1.0 / options.points_per_decade);
    double hi_hz = top_hz;
    double lo_hz = hi_hz;
    while (lo_hz > bottom_hz) {
        lo_hz *= step;
        const Band band = best_band(periodograms, lo_hz, hi_hz);
        const bool is_last = lo_hz <= bottom_hz;
        const bool is_enough = band.periodogram != nullptr && band.dof() >= options.least_dof;
        if (!is_enough && !is_last) { continue; }
        if (band.periodogram != nullptr) { spectrum.points.push_back(point_of(band, options.confidence)); }
        hi_hz = lo_hz;
    }
    std::ranges::reverse(spectrum.points);
    return spectrum;
}

PowerSpectrum power_spectrum(const Column& column, std::span<const Segment> segments, double rate_hz,
                             const SpectrumOptions& options) {
    return power_spectrum(averaged_periodograms(column, segments, rate_hz), options);
}

}  // namespace gyrolog
