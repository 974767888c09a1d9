#include "analysis/diagnose/likelihood/stand_ins.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/numerics/envelope_cholesky.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog::resolution {

// So many are drawn together, as memory is bounded; of these the last only for what they tell of the others.
constexpr std::size_t stand_ins_together = 4096;
constexpr std::size_t stand_ins_beyond = 256;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Missing samples that are taken together, in the order of their slots.
struct Together {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::size_t kept_end = 0;  // Those that follow tell of the ones before only.
};

// Calls take(together, factor) for all parts of the missing samples. What is taken together is eliminated
// from its end on: so the first of them do not depend on the last.
template <typename Take>
void for_each_part(std::span<const std::size_t> slots, const InverseCovariance& inverse, Take take) {
    const std::vector<double>& by_lag = inverse.by_lag;
    std::vector<double> row;
    for (Together part; part.begin < slots.size(); part.begin = part.kept_end) {
        part.end = std::min(part.begin + resolution::stand_ins_together, slots.size());
        part.kept_end = part.end == slots.size() ? part.end : part.end - resolution::stand_ins_beyond;
        EnvelopeCholesky factor(inverse.least);
        std::size_t last = part.end;  // of the slots, the first that is too far away
        for (std::size_t place = part.end; place-- > part.begin;) {
            while (slots[last - 1] - slots[place] >= by_lag.size()) { --last; }
            row.clear();
            for (std::size_t other = last; other-- > place;) {
                row.push_back(by_lag[slots[other] - slots[place]]);
            }
            factor.add_row(row);
        }
        take(part, factor);
    }
}

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
    return {std::move(inverse), 1.0 / (*std::ranges::max_element(density) * rate_hz)};
}

// With C the inverse covariance of all and M the missing ones, x_M + d is drawn from their distribution given
// the others by C_MM d = -(C x)_M + L e, C_MM = L L'.
void draw_stand_ins(std::span<float> values, std::span<const std::size_t> slots,
                    std::span<const double> weighted, const InverseCovariance& inverse,
                    const RandomStream& noise) {
    std::vector<double> steps(slots.size(), 0.0);
    // With the steps that those before `begin` have taken.
    const auto right_side = [&](std::size_t place, std::size_t begin) {
        double sum = -weighted[slots[place]];
        for (std::size_t other = begin; other-- > 0;) {
            const std::size_t lag = slots[place] - slots[other];
            if (lag >= inverse.by_lag.size()) { break; }
            sum -= inverse.by_lag[lag] * steps[other];
        }
        return sum;
    };
    for_each_part(slots, inverse, [&](const Together& part, const EnvelopeCholesky& factor) {
        std::vector<double> drawn(factor.size());
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            drawn[i] = right_side(part.end - 1 - i, part.begin);
        }
        drawn = factor.solve_lower(std::move(drawn));
        for (std::size_t i = 0; i < drawn.size(); ++i) { drawn[i] += noise.normal(slots[part.end - 1 - i]); }
        drawn = factor.solve_transposed(std::move(drawn));
        for (std::size_t place = part.begin; place < part.kept_end; ++place) {
            steps[place] = drawn[part.end - 1 - place];
        }
    });
    for (std::size_t i = 0; i < slots.size(); ++i) { values[slots[i]] += static_cast<float>(steps[i]); }
}

double stand_ins_log_density_nats(std::span<const std::size_t> slots, std::span<const double> weighted,
                                  const InverseCovariance& inverse) {
    double nats = 0.0;
    for_each_part(slots, inverse, [&](const Together& part, const EnvelopeCholesky& factor) {
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
