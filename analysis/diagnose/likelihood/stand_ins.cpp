#include "analysis/diagnose/likelihood/stand_ins.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/numerics/envelope_cholesky.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog::resolution {

// So many are drawn together, as memory is bounded; of these the last only for what they tell of the others.
constexpr std::size_t stand_ins_together = 4096;
constexpr std::size_t stand_ins_beyond = 256;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// What is drawn together is eliminated from its end on: so the first of them do not depend on the last.
class StandIns {
public:
    StandIns(std::span<float> values, const std::vector<bool>& present, std::span<const double> weighted,
             std::span<const double> inverse, double least_inverse, const RandomStream& noise)
        : values_(values),
          weighted_(weighted),
          inverse_(inverse),
          least_inverse_(least_inverse),
          noise_(noise) {
        for (std::size_t slot = 0; slot < present.size(); ++slot) {
            if (!present[slot]) { slots_.push_back(slot); }
        }
        steps_.resize(slots_.size());
    }

    double draw() {
        double log_density_nats = 0.0;
        for (std::size_t begin = 0; begin < slots_.size();) {
            const std::size_t end = std::min(begin + resolution::stand_ins_together, slots_.size());
            const std::size_t kept_end = end == slots_.size() ? end : end - resolution::stand_ins_beyond;
            log_density_nats += draw(begin, end, kept_end);
            begin = kept_end;
        }
        for (std::size_t i = 0; i < slots_.size(); ++i) {
            values_[slots_[i]] += static_cast<float>(steps_[i]);
        }
        return log_density_nats;
    }

private:
    // With C the inverse covariance of all and M the missing ones, x_M + d is drawn from their distribution
    // given the others by C_MM d = -(C x)_M + L e, C_MM = L L'.
    double draw(std::size_t begin, std::size_t end, std::size_t kept_end) {
        const std::size_t size = end - begin;
        const EnvelopeCholesky factor = factor_of(begin, end);
        std::vector<double> right(size);
        for (std::size_t i = 0; i < size; ++i) { right[i] = right_side(end - 1 - i, begin); }
        std::vector<double> drawn = factor.solve_lower(std::move(right));
        double log_density_nats = 0.0;
        for (std::size_t i = 0; i < size; ++i) {
            const double normal = noise_.normal(slots_[end - 1 - i]);
            drawn[i] += normal;
            if (end - 1 - i < kept_end) {
                log_density_nats += std::log(factor.diagonal(i)) - 0.5 * normal * normal;
            }
        }
        drawn = factor.solve_transposed(std::move(drawn));
        for (std::size_t place = begin; place < kept_end; ++place) { steps_[place] = drawn[end - 1 - place]; }
        return log_density_nats;
    }

    EnvelopeCholesky factor_of(std::size_t begin, std::size_t end) const {
        EnvelopeCholesky factor(least_inverse_);
        std::vector<double> row;
        std::size_t last = end;  // of the slots, the first that is too far away
        for (std::size_t place = end; place-- > begin;) {
            while (slots_[last - 1] - slots_[place] >= inverse_.size()) { --last; }
            row.clear();
            for (std::size_t other = last; other-- > place;) {
                row.push_back(inverse_[slots_[other] - slots_[place]]);
            }
            factor.add_row(row);
        }
        return factor;
    }

    // With the steps that those before `begin` have taken.
    double right_side(std::size_t place, std::size_t begin) const {
        double sum = -weighted_[slots_[place]];
        for (std::size_t other = begin; other-- > 0;) {
            const std::size_t lag = slots_[place] - slots_[other];
            if (lag >= inverse_.size()) { break; }
            sum -= inverse_[lag] * steps_[other];
        }
        return sum;
    }

    std::span<float> values_;
    std::span<const double> weighted_;
    std::span<const double> inverse_;
    double least_inverse_;
    const RandomStream& noise_;
    std::vector<std::size_t> slots_;  // that hold no sample
    std::vector<double> steps_;       // of the value of each of them
};

}  // namespace

std::vector<double> inverse_covariance(const SpectralBins& bins, std::span<const double> density,
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
    return inverse;
}

double draw_stand_ins(std::span<float> values, const std::vector<bool>& present,
                      std::span<const double> weighted, std::span<const double> inverse, double least_inverse,
                      const RandomStream& noise) {
    return StandIns(values, present, weighted, inverse, least_inverse, noise).draw();
}

}  // namespace gyrolog
