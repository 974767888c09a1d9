#include "analysis/denoise/unit_bands.hpp"

#include <cmath>
#include <limits>

#include "analysis/denoise/array_noise.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t differences_least = 8;

// One unbroken stretch: unit after unit, `count` averages each.
struct Stretch {
    std::size_t count = 0;
    std::vector<double> averages;
};

std::vector<Stretch> stretches_of(std::span<const Column* const> units, std::span<const Segment> segments) {
    std::vector<Stretch> stretches;
    stretches.reserve(segments.size());
    for (const Segment& segment : segments) {
        Stretch stretch{segment.count, {}};
        stretch.averages.reserve(segment.count * units.size());
        for (const Column* unit : units) {
            // Digits are kept for what varies.
            const double origin = unit->value(segment.first);
            for (std::size_t i = 0; i < segment.count; ++i) {
                stretch.averages.push_back(unit->value(segment.first + i) - origin);
            }
        }
        stretches.push_back(std::move(stretch));
    }
    return stretches;
}

void add_products(const Stretch& stretch, std::size_t units, UnitBand& band) {
    const std::size_t pairs = stretch.count / 2;
    std::vector<double> difference(units);
    for (std::size_t k = 0; k < pairs; ++k) {
        for (std::size_t i = 0; i < units; ++i) {
            const double* averages = stretch.averages.data() + i * stretch.count + 2 * k;
            difference[i] = averages[1] - averages[0];
        }
        for (std::size_t i = 0; i < units; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                band.covariance[i * units + j] += 0.5 * difference[i] * difference[j];
            }
        }
    }
    band.differences += pairs;
}

void halve(Stretch& stretch, std::size_t units) {
    const std::size_t pairs = stretch.count / 2;
    for (std::size_t i = 0; i < units; ++i) {
        for (std::size_t k = 0; k < pairs; ++k) {
            const double* averages = stretch.averages.data() + i * stretch.count + 2 * k;
            stretch.averages[i * pairs + k] = 0.5 * (averages[0] + averages[1]);
        }
    }
    stretch.count = pairs;
}

void find_gains(UnitBand& band, std::size_t units) {
    double sum = 0.0;
    double diagonal = 0.0;
    double correlations = 0.0;
    for (std::size_t i = 0; i < units; ++i) {
        diagonal += band.covariance[i * units + i];
        for (std::size_t j = 0; j < units; ++j) {
            sum += band.covariance[i * units + j];
            if (j < i) { correlations += band.correlation(i, j, units); }
        }
    }
    const auto n = static_cast<double>(units);
    const auto count = static_cast<double>(band.differences);
    const double pairs = 0.5 * n * (n - 1.0);
    if (pairs > 0.0) {
        band.mean_correlation = correlations / pairs;
        band.correlation_sd = 1.0 / std::sqrt(count * pairs);
    }
    if (sum > 0.0) { band.gain_mean = n * diagonal / sum; }
    if (band.differences < 2 * units) { return; }
    const std::vector<double> weights = least_variance_weights(band.covariance, units);
    if (weights.empty()) { return; }
    double least = 0.0;
    for (std::size_t i = 0; i < units; ++i) {
        for (std::size_t j = 0; j < units; ++j) {
            least += weights[i] * weights[j] * band.covariance[i * units + j];
        }
    }
    least *= count / (count - n + 1.0);
    band.gain_best = diagonal / n / least;
}

}  // namespace

double UnitBand::correlation(std::size_t i, std::size_t j, std::size_t units) const {
    const double size = std::sqrt(covariance[i * units + i] * covariance[j * units + j]);
    return size > 0.0 ? covariance[i * units + j] / size : 0.0;
}

double UnitBand::gain_limit() const {
    return mean_correlation > 2.0 * correlation_sd && correlation_sd > 0.0
               ? 1.0 / mean_correlation
               : std::numeric_limits<double>::infinity();
}

std::vector<UnitBand> unit_bands(std::span<const Column* const> units, std::span<const Segment> segments,
                                 double rate_hz) {
    std::vector<UnitBand> bands;
    std::vector<Stretch> stretches = stretches_of(units, segments);
    for (double tau_s = 1.0 / rate_hz;;) {
        UnitBand band;
        band.tau_s = tau_s;
        band.from_hz = 0.25 / tau_s;
        band.to_hz = 0.5 / tau_s;
        band.covariance.assign(units.size() * units.size(), 0.0);
        for (Stretch& stretch : stretches) {
            add_products(stretch, units.size(), band);
            halve(stretch, units.size());
        }
        if (band.differences < differences_least) { return bands; }
        for (std::size_t i = 0; i < units.size(); ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                band.covariance[i * units.size() + j] /= static_cast<double>(band.differences);
                band.covariance[j * units.size() + i] = band.covariance[i * units.size() + j];
            }
        }
        find_gains(band, units.size());
        bands.push_back(std::move(band));
        tau_s *= 2.0;
    }
}

}  // namespace gyrolog
