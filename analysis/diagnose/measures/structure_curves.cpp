#include "analysis/diagnose/measures/structure_curves.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <variant>
#include <vector>

#include "analysis/diagnose/likelihood/repeat_patterns.hpp"
#include "analysis/numerics/tail_probability.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog {

namespace {

constexpr std::size_t repeat_lags = 2;
constexpr std::size_t compared_lags = 4;  // after those
constexpr std::size_t period_least = 4;
constexpr std::size_t period_most = 4096;
constexpr double repetitions_least = 8.0;
// A drift or a line is none of this; of what comes back often, no multiple is this strong by itself.
constexpr double power_most = 8.0;

// In coefficients, half a line's natural width each.
constexpr std::array<std::size_t, 4> narrow_widths = {4, 16, 64, 256};
// Below the bands that hold the broadest of them.
constexpr std::array<std::size_t, 3> slow_widths = {2, 4, 16};

constexpr std::size_t codes_around = 6;  // on either side
constexpr double code_count_least = 8.0;
constexpr double log_mean_most = 40.0;

double square(double value) { return value * value; }

using RepeatCounts = std::array<double, repeat_lags + compared_lags>;  // by lag, from 1 on

RepeatCounts count_repeats(const Recording& recording, std::size_t axis) {
    std::array<std::size_t, repeat_lags + compared_lags> repeats{};
    std::visit(
        [&](const auto& data) {
            const ValueRange range(data);
            for (const Segment& segment : recording.segments) {
                const std::size_t end = segment.first + segment.count;
                for (std::size_t row = segment.first + 1; row < end; ++row) {
                    const auto value = data[row];
                    const bool counts_here = !range.ends_at(value);
                    const std::size_t lags = std::min(repeats.size(), row - segment.first);
                    for (std::size_t lag = 1; lag <= lags; ++lag) {
                        repeats[lag - 1] += std::size_t{counts_here && data[row - lag] == value};
                    }
                }
            }
        },
        recording.find(gyro_columns.at(axis))->data);
    RepeatCounts counts{};
    std::ranges::copy(repeats, counts.begin());
    return counts;
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
        curve.x.push_back(static_cast<double>(lag + 1) / observation.prediction().rate_hz());
        const double variance = counts[lag] + compared / static_cast<double>(compared_lags) + 1.0;
        curve.value.push_back((counts[lag] - compared) / std::sqrt(variance));
    }
    return curve;
}

GapCurve period_curve(const Observation& observation, std::size_t axis) {
    const Prediction& prediction = observation.prediction();
    const AxisObservation& seen = observation.axis(axis);
    // The inverse transform of the whitened power is its autocorrelation, half a sample beside the whole
    // lags: two neighbours together are the one at the lag between them, seen through a slight low-pass.
    std::vector<float> correlation(seen.cosines.size(), 0.0F);
    for (std::size_t i = 0; i < prediction.bins().size(); ++i) {
        const double expected = seen.density[i] * prediction.rate_hz();
        for (std::size_t k = std::max<std::size_t>(prediction.bins()[i].first, 1);
             k < prediction.bins()[i].end; ++k) {
            const double power = square(static_cast<double>(seen.cosines[k])) / expected;
            correlation[k] = static_cast<float>(std::min(power, power_most) - 1.0);
        }
    }
    prediction.transform()->inverse(std::span<float>(correlation));
    for (std::size_t lag = correlation.size() - 1; lag > 0; --lag) {
        correlation[lag] += correlation[lag - 1];
    }
    const std::size_t lags = correlation.size() / 2;
    double squares = 0.0;
    for (std::size_t lag = period_least; lag < lags; ++lag) {
        squares += square(static_cast<double>(correlation[lag]));
    }
    const double sd = std::sqrt(squares / static_cast<double>(lags - period_least));
    GapCurve curve{GapDomainKind::period, axis, axis, {}, {}};
    for (std::size_t from = period_least; from < period_most; from *= 2) {
        if (static_cast<double>(lags) / static_cast<double>(2 * from) < repetitions_least) { break; }
        double most = 0.0;
        for (std::size_t period = from; period < 2 * from; ++period) {
            double sum = 0.0;
            double multiples = 0.0;
            for (std::size_t lag = period; lag < lags; lag += period) {
                sum += static_cast<double>(correlation[lag]);
                multiples += 1.0;
            }
            most = std::max(most, sum / std::sqrt(multiples));
        }
        // Half the chance of either sign's square.
        const double surprise = surprise_of_largest(square(most / sd), 1.0, 0.5 * static_cast<double>(from));
        curve.x.push_back(static_cast<double>(from) * std::sqrt(2.0) / prediction.rate_hz());
        curve.value.push_back(deviate_of(surprise));
    }
    return curve;
}

namespace {

struct Window {
    double surprise_nats = 0.0;
    double place = 0.0;  // its middle, in coefficients from the first
};

// `sums`: of the whitened power, from 0. `level`: what is expected of one coefficient.
Window most_surprising(const std::vector<double>& sums, std::span<const std::size_t> widths, double level) {
    const auto all = static_cast<double>(sums.size() - 1);
    Window best{0.0, 0.5 * all};
    for (const std::size_t width : widths) {
        double most = 0.0;
        std::size_t at = 0;
        for (std::size_t from = 0; from + width < sums.size(); from += width / 2) {
            const double sum = sums[from + width] - sums[from];
            if (sum > most) { most = sum, at = from; }
        }
        // Windows that overlap by half are nearly as good as independent.
        const double tries = 2.0 * all / static_cast<double>(width) * static_cast<double>(widths.size());
        const double surprise = surprise_of_largest(most / level, static_cast<double>(width), tries);
        if (surprise > best.surprise_nats) {
            best = {surprise, static_cast<double>(at) + 0.5 * static_cast<double>(width)};
        }
    }
    return best;
}

std::vector<double> whitened_sums(const Observation& observation, std::size_t axis, std::size_t from_bin,
                                  std::size_t end_bin) {
    const Prediction& prediction = observation.prediction();
    const AxisObservation& seen = observation.axis(axis);
    std::vector<double> sums(1, 0.0);
    for (std::size_t i = from_bin; i < end_bin; ++i) {
        const double expected = seen.density[i] * prediction.rate_hz();
        for (std::size_t k = prediction.bins()[i].first; k < prediction.bins()[i].end; ++k) {
            sums.push_back(sums.back() + square(static_cast<double>(seen.cosines[k])) / expected);
        }
    }
    return sums;
}

}  // namespace

GapCurve narrow_curve(const Observation& observation, std::size_t axis,
                      const std::vector<std::size_t>& edges) {
    const Prediction& prediction = observation.prediction();
    GapCurve curve{GapDomainKind::narrow, axis, axis, {}, {}};
    const auto add = [&](std::size_t first, const Window& window) {
        curve.x.push_back(0.5 * (static_cast<double>(first) + window.place) / prediction.duration_s());
        curve.value.push_back(deviate_of(window.surprise_nats));
    };
    std::size_t band = 0;
    const auto coefficients = [&](std::size_t of) {
        return prediction.bins()[edges[of + 1] - 1].end - prediction.bins()[edges[of]].first;
    };
    while (band + 1 < edges.size() && coefficients(band) < narrow_widths.back()) { ++band; }
    const std::vector<double> slow = whitened_sums(observation, axis, 0, edges[band]);
    if (slow.size() > slow_widths.back()) {
        add(prediction.bins()[0].first, most_surprising(slow, slow_widths, 1.0));
    }
    for (; band + 1 < edges.size(); ++band) {
        const std::vector<double> sums = whitened_sums(observation, axis, edges[band], edges[band + 1]);
        // Of a broad excess, what stands out of it.
        const double level = std::max(1.0, sums.back() / static_cast<double>(sums.size() - 1));
        add(prediction.bins()[edges[band]].first, most_surprising(sums, narrow_widths, level));
    }
    return curve;
}

namespace {

// How often each code of the converter was shown, from codes_around below the least to as far above the
// largest.
std::vector<double> count_codes(const Recording& recording, std::size_t axis, double lsb_rad_s) {
    constexpr double codes_most = 1 << 20;
    const Column& column = *recording.find(gyro_columns.at(axis));
    const double codes_per_number = column.scale / lsb_rad_s;
    return std::visit(
        [&](const auto& data) -> std::vector<double> {
            if (data.empty()) { return {}; }
            const auto [least, most] = std::ranges::minmax(data);
            const double one_end = static_cast<double>(least) * codes_per_number;
            const double other_end = static_cast<double>(most) * codes_per_number;
            const double first = std::round(std::min(one_end, other_end));
            const double codes = std::round(std::max(one_end, other_end)) - first;
            if (codes > codes_most) { return {}; }
            std::vector<double> counts(static_cast<std::size_t>(codes) + 1 + 2 * codes_around, 0.0);
            const double from = first - static_cast<double>(codes_around);
            for (const auto number : data) {
                const double code = static_cast<double>(number) * codes_per_number - from;
                counts[static_cast<std::size_t>(std::max(code + 0.5, 0.0))] += 1.0;
            }
            return counts;
        },
        column.data);
}

// What the codes around say of one: a parabola through the logarithms of their counts, which a normal density
// is. The code itself and its neighbours, that have what it lacks, are left out.
struct ExpectedCount {
    double count = 0.0;
    double rel_variance = 0.0;
};

// By the scoring iterations of a Poisson regression. `counts` goes on by codes_around beyond the code.
ExpectedCount expected_count(const std::vector<double>& counts, std::size_t code) {
    constexpr int iterations = 6;
    constexpr double least_start = 0.5;
    const auto first = counts.begin() + static_cast<std::ptrdiff_t>(code - codes_around);
    const double all = std::accumulate(first, first + 2 * codes_around + 1, 0.0);
    if (all < code_count_least) { return {}; }
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    Eigen::LDLT<Eigen::Matrix3d> solver;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i <= 2 * codes_around; ++i) {
            const double away = static_cast<double>(i) - static_cast<double>(codes_around);
            if (std::fabs(away) < 2.0) { continue; }
            const double count = counts[code - codes_around + i];
            const Eigen::Vector3d powers(1.0, away, away * away);
            const double log_mean = iteration == 0 ? std::log(std::max(count, least_start)) : powers.dot(at);
            const double mean = std::exp(std::min(log_mean, log_mean_most));
            normal.noalias() += mean * powers * powers.transpose();
            right += (mean * log_mean + count - mean) * powers;
        }
        solver.compute(normal);
        if (!(solver.rcond() > 1e-10)) { return {}; }
        at = solver.solve(right);
    }
    return {std::exp(at[0]), solver.solve(Eigen::Vector3d::UnitX())[0]};
}

// Twice the log likelihood ratio of a Poisson count, sharing its chance with that of what is expected.
double deviance(double count, const ExpectedCount& expected) {
    const double log_part = count > 0.0 ? count * std::log(count / expected.count) : 0.0;
    return 2.0 * (log_part - count + expected.count) / (1.0 + expected.count * expected.rel_variance);
}

// Of the code, or of it and the next, that is most at odds with those around.
double most_surprising_code(const std::vector<double>& counts) {
    double most_alone = 0.0;
    double most_of_two = 0.0;
    double tries = 0.0;
    double before = 0.0;
    for (std::size_t code = codes_around; code + codes_around < counts.size(); ++code) {
        const ExpectedCount expected = expected_count(counts, code);
        if (!(expected.count >= code_count_least)) {
            before = 0.0;
            continue;
        }
        const double own = deviance(counts[code], expected);
        most_alone = std::max(most_alone, own);
        most_of_two = std::max(most_of_two, own + before);
        before = own;
        tries += 1.0;
    }
    if (!(tries > 0.0)) { return 0.0; }
    const double surprise = std::max(surprise_of_largest(most_alone, 1.0, 2.0 * tries),
                                     surprise_of_largest(most_of_two, 2.0, 2.0 * tries));
    return deviate_of(surprise);
}

}  // namespace

GapCurve codes_curve(const Observation& observation, std::size_t axis) {
    const double lsb_rad_s = observation.prediction().model().lsb_rad_s;
    GapCurve curve{GapDomainKind::codes, axis, axis, {1.0, 2.0}, {0.0, 0.0}};
    // What moves shows each code for as long as the motion has it.
    if (!(lsb_rad_s > 0.0) || observation.prediction().moves()) { return curve; }
    const std::vector<double> counts = count_codes(observation.recording(), axis, lsb_rad_s);
    double balance = 0.0;
    double all = 0.0;
    for (std::size_t code = 0; code < counts.size(); ++code) {
        balance += code % 2 == 0 ? counts[code] : -counts[code];
        all += counts[code];
    }
    curve.value[0] = most_surprising_code(counts);
    curve.value[1] = std::fabs(balance) / std::sqrt(std::max(all, 1.0));
    return curve;
}

}  // namespace gyrolog
