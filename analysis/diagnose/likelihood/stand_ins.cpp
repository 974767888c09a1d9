#include "analysis/diagnose/likelihood/stand_ins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog::resolution {

// Samples that are drawn together: with 64 lags their factor has 2 MB at most.
constexpr std::size_t stand_ins_together = 4096;
// Samples at the end of these that only tell of the others: four times the lags.
constexpr std::size_t stand_ins_beyond = 256;
// Frequencies for each lag, at which a series is looked at. Between two the fastest term falls by 2 % of
// itself, 1 - cos(pi / 16).
constexpr std::size_t steps_per_lag = 8;
// Numbers of factors that are kept: 32 MB.
constexpr std::size_t kept_values = std::size_t{1} << 22U;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// The least of c_0 + 2 sum of c_k cos(k w).
double least_of_series(std::span<const double> by_lag) {
    const std::size_t steps = resolution::steps_per_lag * by_lag.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t step = 0; step <= steps; ++step) {
        // Clenshaw's recurrence.
        const double cosine = std::cos(pi * static_cast<double>(step) / static_cast<double>(steps));
        double here = 0.0;
        double after = 0.0;
        for (std::size_t k = by_lag.size(); k-- > 1;) {
            after = std::exchange(here, by_lag[k] + 2.0 * cosine * here - after);
        }
        least = std::min(least, by_lag[0] + 2.0 * (cosine * here - after));
    }
    return least;
}

// Calls take(part) for all parts of the missing samples.
template <typename Take>
void for_each_part(std::span<const std::size_t> slots, const InverseCovariance& inverse, Take take) {
    const std::vector<double>& by_lag = inverse.by_lag;
    std::vector<double> row;
    for (std::size_t begin = 0; begin < slots.size();) {
        const std::size_t end = std::min(begin + resolution::stand_ins_together, slots.size());
        const std::size_t kept_end = end == slots.size() ? end : end - resolution::stand_ins_beyond;
        StandInPart part{begin, end, kept_end, EnvelopeCholesky(inverse.least)};
        std::size_t last = part.end;  // of the slots, the first that is too far away
        for (std::size_t place = part.end; place-- > part.begin;) {
            while (slots[last - 1] - slots[place] >= by_lag.size()) { --last; }
            row.clear();
            for (std::size_t other = last; other-- > place;) {
                row.push_back(by_lag[slots[other] - slots[place]]);
            }
            part.factor.add_row(row);
        }
        begin = kept_end;
        take(std::move(part));
    }
}

// Of the slots' values x the steps d by C d = right + L e, where C = L L' is the inverse covariance among
// them. `for_each`: calls what it is given for all parts.
template <typename ForEach, typename Right, typename Normal>
void take_steps(std::span<float> values, std::span<const std::size_t> slots, const InverseCovariance& inverse,
                ForEach for_each, Right right_of, Normal normal_of) {
    std::vector<double> steps(slots.size(), 0.0);
    // With the steps that those before `begin` have taken.
    const auto right_side = [&](std::size_t place, std::size_t begin) {
        double sum = right_of(slots[place]);
        for (std::size_t other = begin; other-- > 0;) {
            const std::size_t lag = slots[place] - slots[other];
            if (lag >= inverse.by_lag.size()) { break; }
            sum -= inverse.by_lag[lag] * steps[other];
        }
        return sum;
    };
    for_each([&](const StandInPart& part) {
        std::vector<double> step(part.factor.size());
        for (std::size_t i = 0; i < step.size(); ++i) { step[i] = right_side(part.end - 1 - i, part.begin); }
        step = part.factor.solve_lower(std::move(step));
        for (std::size_t i = 0; i < step.size(); ++i) { step[i] += normal_of(slots[part.end - 1 - i]); }
        step = part.factor.solve_transposed(std::move(step));
        for (std::size_t place = part.begin; place < part.kept_end; ++place) {
            steps[place] = step[part.end - 1 - place];
        }
    });
    for (std::size_t i = 0; i < slots.size(); ++i) { values[slots[i]] += static_cast<float>(steps[i]); }
}

constexpr auto none = [](std::size_t) { return 0.0; };

}  // namespace

InverseCovariance inverse_covariance(const SpectralBins& bins, std::span<const double> density,
                                     double rate_hz, std::size_t length, std::size_t lags) {
    std::vector<double> inverse(lags + 1, 0.0);
    const auto whole = static_cast<double>(length);
    double from = 0.0;  // in coefficients
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const double to = i + 1 == bins.size() ? whole : static_cast<double>(bins[i].end) - 0.5;
        const double per_variance = 1.0 / (density[i] * rate_hz);
        inverse[0] += per_variance * (to - from) / whole;
        for (std::size_t k = 1; k <= lags; ++k) {
            const double angle = pi * static_cast<double>(k) / whole;
            inverse[k] += per_variance * (std::sin(angle * to) - std::sin(angle * from)) /
                          (pi * static_cast<double>(k));
        }
        from = to;
    }
    const double least = 1.0 / (*std::ranges::max_element(density) * rate_hz);
    // Cut off, the series may fall below zero beside a strong band, and the matrix is no inverse of a
    // covariance.
    inverse[0] += std::max(0.0, least - least_of_series(inverse));
    return {std::move(inverse), least};
}

void draw_stand_ins(std::span<float> values, std::span<const std::size_t> slots,
                    std::span<const double> weighted, const InverseCovariance& expectation,
                    const InverseCovariance& scatter, const RandomStream& noise) {
    const auto towards = [&](std::size_t slot) { return -weighted[slot]; };
    const auto worked_out = [&](const InverseCovariance& inverse) {
        return [&](const auto& take) { for_each_part(slots, inverse, take); };
    };
    if (expectation.by_lag == scatter.by_lag) {
        take_steps(values, slots, scatter, worked_out(scatter), towards,
                   [&](std::size_t slot) { return noise.normal(slot); });
    } else {
        take_steps(values, slots, expectation, worked_out(expectation), towards, none);
        scatter_stand_ins(values, slots, scatter, noise);
    }
}

void scatter_stand_ins(std::span<float> values, std::span<const std::size_t> slots,
                       const InverseCovariance& inverse, const RandomStream& noise) {
    take_steps(
        values, slots, inverse, [&](const auto& take) { for_each_part(slots, inverse, take); }, none,
        [&](std::size_t slot) { return noise.normal(slot); });
}

ExpectedStandIns::ExpectedStandIns(std::vector<std::size_t> slots, InverseCovariance inverse)
    : slots_(std::move(slots)), inverse_(std::move(inverse)) {
    std::size_t values = 0;
    for_each_part(slots_, inverse_, [&](StandInPart part) {
        values += part.factor.numbers();
        if (values <= resolution::kept_values) { parts_.push_back(std::move(part)); }
    });
    if (values > resolution::kept_values) { parts_ = {}; }
}

void ExpectedStandIns::expect(std::span<float> values, std::span<const double> weighted) const {
    const auto for_each = [&](const auto& take) {
        if (parts_.empty()) { return for_each_part(slots_, inverse_, take); }
        for (const StandInPart& part : parts_) { take(part); }
    };
    take_steps(
        values, slots_, inverse_, for_each, [&](std::size_t slot) { return -weighted[slot]; }, none);
}

double stand_ins_log_density_nats(std::span<const std::size_t> slots, std::span<const double> weighted,
                                  const InverseCovariance& inverse) {
    double nats = 0.0;
    for_each_part(slots, inverse, [&](const StandInPart& part) {
        const EnvelopeCholesky& factor = part.factor;
        std::vector<double> normal(factor.size());
        for (std::size_t i = 0; i < normal.size(); ++i) { normal[i] = weighted[slots[part.end - 1 - i]]; }
        normal = factor.solve_lower(std::move(normal));
        for (std::size_t i = part.end - part.kept_end; i < normal.size(); ++i) {
            nats += std::log(factor.diagonal(i)) - 0.5 * normal[i] * normal[i];
        }
    });
    return nats;
}

}  // namespace gyrolog
