#include "analysis/diagnose/structure_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/gamma.hpp>

#include "analysis/diagnose/repeat_patterns.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog {

namespace {

constexpr std::size_t repeat_lags = 2;
constexpr std::size_t compared_lags = 4;  // after those
constexpr std::size_t memory_blocks_least = 16;
constexpr std::size_t period_least = 4;
constexpr std::size_t period_most = 4096;
constexpr double repetitions_least = 8.0;
// A drift or a line is none of this; of what comes back often, no multiple is this strong by itself.
constexpr double power_most = 8.0;

// In coefficients, half a line's natural width each.
constexpr std::array<std::size_t, 4> narrow_widths = {4, 16, 64, 256};

double square(double value) { return value * value; }

using RepeatCounts = std::array<double, repeat_lags + compared_lags>;  // by lag, from 1 on

RepeatCounts count_repeats(const Recording& recording, std::size_t axis) {
    RepeatCounts counts{};
    std::visit(
        [&](const auto& data) {
            const ValueRange range(data);
            for (const Segment& segment : recording.segments) {
                for (std::size_t lag = 1; lag <= counts.size() && lag < segment.count; ++lag) {
                    std::size_t count = 0;
                    for (std::size_t row = segment.first + lag; row < segment.first + segment.count; ++row) {
                        const bool repeats = data[row] == data[row - lag] && !range.ends_at(data[row]);
                        count += std::size_t{repeats};
                    }
                    counts[lag - 1] += static_cast<double>(count);
                }
            }
        },
        recording.find(gyro_columns.at(axis))->data);
    return counts;
}

// -ln of the chance that the largest of `tries` chi-square numbers is this large.
double surprise_of_largest(double value, double degrees, double tries) {
    const double chance = boost::math::gamma_q(0.5 * degrees, 0.5 * value);
    return -std::log(-std::expm1(tries * std::log1p(-std::max(chance, 1e-280))));
}

// The normal deviate that is as rare.
double deviate_of(double surprise_nats) {
    const double chance = std::clamp(std::exp(-surprise_nats), 1e-280, 0.99);
    return boost::math::quantile(boost::math::complement(boost::math::normal(), chance));
}

}  // namespace

GapCurve repeats_curve(const Observation& observation, std::size_t axis) {
    const RepeatCounts counts = count_repeats(observation.recording(), axis);
    double compared = 0.0;
    for (std::size_t lag = repeat_lags; lag < counts.size(); ++lag) {
        compared += counts[lag] / static_cast<double>(compared_lags);
    }
    GapCurve curve{GapDomainKind::repeats, axis, axis, {}, {}};
    for (std::size_t lag = 0; lag < repeat_lags; ++lag) {
        curve.x.push_back(static_cast<double>(lag + 1) / observation.baseline().rate_hz());
        const double variance = counts[lag] + compared / static_cast<double>(compared_lags) + 1.0;
        curve.value.push_back((counts[lag] - compared) / std::sqrt(variance));
    }
    return curve;
}

GapCurve memory_curve(const Observation& observation, std::size_t axis) {
    const std::vector<float>& white = observation.axis(axis).whitened;
    std::vector<double> means;  // of the blocks
    means.reserve(white.size());
    double mean = 0.0;
    for (std::size_t slot = 0; slot < white.size(); ++slot) {
        if (!observation.present()[slot]) { continue; }
        means.push_back(square(static_cast<double>(white[slot])));
        mean += means.back();
    }
    mean /= static_cast<double>(std::max<std::size_t>(means.size(), 1));
    double variance = 0.0;
    for (const double value : means) { variance += square(value - mean); }
    variance /= static_cast<double>(std::max<std::size_t>(means.size(), 1));
    GapCurve curve{GapDomainKind::memory, axis, axis, {}, {}};
    // As many points for every observation, however many of its samples are to be judged.
    const std::size_t slots = white.size();
    for (std::size_t length = 1; slots / length >= memory_blocks_least; length *= 2) {
        double sum = 0.0;
        for (std::size_t i = 0; i + 1 < means.size(); i += 2) {
            sum += square(means[i + 1] - means[i]);
            means[i / 2] = 0.5 * (means[i] + means[i + 1]);
        }
        const std::size_t pairs = means.size() / 2;
        means.resize(pairs);
        const double expected = 2.0 * variance / static_cast<double>(length) * static_cast<double>(pairs);
        curve.x.push_back(static_cast<double>(length) / observation.baseline().rate_hz());
        // Few pairs are far from normal; the cube root is nearer (see the spectrum's).
        curve.value.push_back(expected > 0.0 ? std::cbrt(sum / expected) - 1.0 : 0.0);
    }
    return curve;
}

GapCurve period_curve(const Observation& observation, std::size_t axis) {
    const Baseline& baseline = observation.baseline();
    const AxisObservation& seen = observation.axis(axis);
    // The inverse transform of the whitened power is its autocorrelation, half a sample beside the whole
    // lags: two neighbours together are the one at the lag between them, seen through a slight low-pass.
    std::vector<double> correlation(seen.cosines.size(), 0.0);
    for (std::size_t i = 0; i < baseline.bins().size(); ++i) {
        const double expected = seen.density[i] * baseline.rate_hz();
        for (std::size_t k = std::max<std::size_t>(baseline.bins()[i].first, 1); k < baseline.bins()[i].end;
             ++k) {
            const double power = square(static_cast<double>(seen.cosines[k])) / expected;
            correlation[k] = std::min(power, power_most) - 1.0;
        }
    }
    baseline.transform()->inverse(correlation);
    for (std::size_t lag = correlation.size() - 1; lag > 0; --lag) {
        correlation[lag] += correlation[lag - 1];
    }
    const std::size_t lags = correlation.size() / 2;
    double squares = 0.0;
    for (std::size_t lag = period_least; lag < lags; ++lag) { squares += square(correlation[lag]); }
    const double sd = std::sqrt(squares / static_cast<double>(lags - period_least));
    GapCurve curve{GapDomainKind::period, axis, axis, {}, {}};
    for (std::size_t from = period_least; from < period_most; from *= 2) {
        if (static_cast<double>(lags) / static_cast<double>(2 * from) < repetitions_least) { break; }
        double most = 0.0;
        for (std::size_t period = from; period < 2 * from; ++period) {
            double sum = 0.0;
            double multiples = 0.0;
            for (std::size_t lag = period; lag < lags; lag += period) {
                sum += correlation[lag];
                multiples += 1.0;
            }
            most = std::max(most, sum / std::sqrt(multiples));
        }
        // Half the chance of either sign's square.
        const double surprise = surprise_of_largest(square(most / sd), 1.0, 0.5 * static_cast<double>(from));
        curve.x.push_back(static_cast<double>(from) * std::sqrt(2.0) / baseline.rate_hz());
        curve.value.push_back(deviate_of(surprise));
    }
    return curve;
}

GapCurve narrow_curve(const Observation& observation, std::size_t axis,
                      const std::vector<std::size_t>& edges) {
    const Baseline& baseline = observation.baseline();
    const AxisObservation& seen = observation.axis(axis);
    GapCurve curve{GapDomainKind::narrow, axis, axis, {}, {}};
    std::vector<double> sums;  // of the whitened power
    for (std::size_t band = 0; band + 1 < edges.size(); ++band) {
        const std::size_t first = baseline.bins()[edges[band]].first;
        const std::size_t end = baseline.bins()[edges[band + 1] - 1].end;
        if (end - first < narrow_widths.back()) { continue; }
        sums.assign(1, 0.0);
        for (std::size_t i = edges[band]; i < edges[band + 1]; ++i) {
            const double expected = seen.density[i] * baseline.rate_hz();
            for (std::size_t k = baseline.bins()[i].first; k < baseline.bins()[i].end; ++k) {
                sums.push_back(sums.back() + square(static_cast<double>(seen.cosines[k])) / expected);
            }
        }
        // Of a broad excess, what stands out of it.
        const auto all = static_cast<double>(sums.size() - 1);
        const double level = std::max(1.0, sums.back() / all);
        double surprise = 0.0;
        double place = 0.5 * static_cast<double>(first + end);
        for (const std::size_t width : narrow_widths) {
            double most = 0.0;
            std::size_t at = 0;
            for (std::size_t from = 0; from + width < sums.size(); from += width / 2) {
                const double sum = sums[from + width] - sums[from];
                if (sum > most) { most = sum, at = from; }
            }
            // Windows that overlap by half are nearly as good as independent.
            const double tries =
                2.0 * all / static_cast<double>(width) * static_cast<double>(narrow_widths.size());
            const double of_width = surprise_of_largest(most / level, static_cast<double>(width), tries);
            if (of_width > surprise) {
                surprise = of_width;
                place = static_cast<double>(first + at) + 0.5 * static_cast<double>(width);
            }
        }
        curve.x.push_back(0.5 * place / baseline.duration_s());
        curve.value.push_back(deviate_of(surprise));
    }
    return curve;
}

}  // namespace gyrolog
