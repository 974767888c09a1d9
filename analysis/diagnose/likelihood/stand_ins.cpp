#include "analysis/diagnose/likelihood/stand_ins.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/matrix.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog::resolution {

// Samples that are drawn together. A longer hole has several such blocks.
constexpr std::size_t stand_in_block_samples = 32;
// The first turn sees first guesses beside a block, the second what the first has drawn.
constexpr int stand_in_turns = 2;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// The record goes on mirrored, as the cosine transform has it.
std::size_t mirrored(std::ptrdiff_t slot, std::size_t length) {
    const auto end = static_cast<std::ptrdiff_t>(length);
    if (slot < 0) { slot = -1 - slot; }
    if (slot >= end) { slot = 2 * end - 1 - slot; }
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(slot, 0, end - 1));
}

CholeskyFactor toeplitz_factor(std::span<const double> row, std::size_t size) {
    Matrix matrix(size, size);
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < size; ++j) {
            const std::size_t lag = i > j ? i - j : j - i;
            matrix(i, j) = lag < row.size() ? row[lag] : 0.0;
        }
    }
    return CholeskyFactor(matrix);
}

class StandIns {
public:
    StandIns(std::span<float> values, std::span<const double> inverse, const RandomStream& noise)
        : values_(values), inverse_(inverse), noise_(noise) {}

    void draw(std::size_t begin, std::size_t end) {
        const std::size_t size = end - begin;
        const CholeskyFactor& factor = factor_of(size);
        if (!factor.is_positive_definite()) { return; }
        const auto lags = static_cast<std::ptrdiff_t>(inverse_.size()) - 1;
        const auto first = static_cast<std::ptrdiff_t>(begin);
        const auto last = static_cast<std::ptrdiff_t>(end);
        const double level = level_beside(first, last, lags);
        std::vector<double> right(size, 0.0);
        for (std::size_t i = 0; i < size; ++i) {
            const std::ptrdiff_t own = first + static_cast<std::ptrdiff_t>(i);
            for (std::ptrdiff_t at = own - lags; at <= own + lags; ++at) {
                if (at >= first && at < last) { continue; }
                right[i] -= inverse_[static_cast<std::size_t>(std::abs(at - own))] * (value_at(at) - level);
            }
        }
        const std::vector<double> mean = factor.solve(right);
        for (std::size_t i = 0; i < size; ++i) { right[i] = noise_.normal(begin + i); }
        const std::vector<double> by_chance = factor.solve_transposed(right);
        for (std::size_t i = 0; i < size; ++i) {
            values_[begin + i] = static_cast<float>(level + mean[i] + by_chance[i]);
        }
    }

private:
    double value_at(std::ptrdiff_t slot) const {
        return static_cast<double>(values_[mirrored(slot, values_.size())]);
    }

    double level_beside(std::ptrdiff_t first, std::ptrdiff_t last, std::ptrdiff_t lags) const {
        double sum = 0.0;
        for (std::ptrdiff_t lag = 0; lag < lags; ++lag) {
            sum += value_at(first - 1 - lag) + value_at(last + lag);
        }
        return lags > 0 ? sum / (2.0 * static_cast<double>(lags)) : 0.0;
    }

    const CholeskyFactor& factor_of(std::size_t size) {
        const auto known = factors_.find(size);
        if (known != factors_.end()) { return known->second; }
        return factors_.emplace(size, toeplitz_factor(inverse_, size)).first->second;
    }

    std::span<float> values_;
    std::span<const double> inverse_;
    const RandomStream& noise_;
    std::map<std::size_t, CholeskyFactor> factors_;  // by size
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

void draw_stand_ins(std::span<float> values, const std::vector<bool>& present,
                    std::span<const double> inverse, const RandomStream& noise) {
    StandIns stand_ins(values, inverse, noise);
    for (int turn = 0; turn < resolution::stand_in_turns; ++turn) {
        for (std::size_t begin = 0; begin < values.size();) {
            if (present[begin]) {
                ++begin;
                continue;
            }
            std::size_t end = begin;
            while (end < values.size() && !present[end] && end - begin < resolution::stand_in_block_samples) {
                ++end;
            }
            stand_ins.draw(begin, end);
            begin = end;
        }
    }
}

}  // namespace gyrolog
