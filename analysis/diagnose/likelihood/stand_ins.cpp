#include "analysis/diagnose/likelihood/stand_ins.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/numerics/cholesky.hpp"
#include "analysis/numerics/matrix.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog::resolution {

// Samples that are drawn together. A longer hole has several such blocks.
constexpr std::size_t block_samples = 32;
// The first turn sees first guesses beside a block, the second what the first has drawn.
constexpr int turns = 2;

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
        const auto found = factors_.try_emplace(size, toeplitz_factor(inverse_, size)).first;
        const CholeskyFactor& factor = found->second;
        if (!factor.is_positive_definite()) { return; }
        std::vector<double> right(size, 0.0);
        const auto lags = static_cast<std::ptrdiff_t>(inverse_.size()) - 1;
        const auto first = static_cast<std::ptrdiff_t>(begin);
        const auto last = static_cast<std::ptrdiff_t>(end);
        for (std::size_t i = 0; i < size; ++i) {
            const std::ptrdiff_t own = first + static_cast<std::ptrdiff_t>(i);
            for (std::ptrdiff_t at = own - lags; at <= own + lags; ++at) {
                if (at >= first && at < last) { continue; }
                const std::size_t lag = static_cast<std::size_t>(std::abs(at - own));
                right[i] -= inverse_[lag] * static_cast<double>(values_[mirrored(at, values_.size())]);
            }
        }
        const std::vector<double> mean = factor.solve(right);
        for (std::size_t i = 0; i < size; ++i) { right[i] = noise_.normal(begin + i); }
        const std::vector<double> by_chance = factor.solve_transposed(right);
        for (std::size_t i = 0; i < size; ++i) {
            values_[begin + i] = static_cast<float>(mean[i] + by_chance[i]);
        }
    }

private:
    std::span<float> values_;
    std::span<const double> inverse_;
    const RandomStream& noise_;
    std::map<std::size_t, CholeskyFactor> factors_;  // by size
};

}  // namespace

std::vector<double> inverse_covariance(const SpectralBins& bins, std::span<const double> density,
                                       double rate_hz, std::size_t length, std::size_t lags) {
    std::vector<double> covariance(lags + 1, 0.0);
    const auto whole = static_cast<double>(length);
    double from = 0.0;  // in coefficients
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const double to = i + 1 == bins.size() ? whole : static_cast<double>(bins[i].end) - 0.5;
        const double inverse = 1.0 / (density[i] * rate_hz);
        covariance[0] += inverse * (to - from) / whole;
        for (std::size_t k = 1; k <= lags; ++k) {
            const double angle = pi * static_cast<double>(k) / whole;
            covariance[k] +=
                inverse * (std::sin(angle * to) - std::sin(angle * from)) / (pi * static_cast<double>(k));
        }
        from = to;
    }
    return covariance;
}

void draw_stand_ins(std::span<float> values, const std::vector<bool>& present,
                    std::span<const double> covariance_inverse, const RandomStream& noise) {
    StandIns stand_ins(values, covariance_inverse, noise);
    for (int turn = 0; turn < resolution::turns; ++turn) {
        for (std::size_t begin = 0; begin < values.size();) {
            if (present[begin]) {
                ++begin;
                continue;
            }
            std::size_t end = begin;
            while (end < values.size() && !present[end] && end - begin < resolution::block_samples) { ++end; }
            stand_ins.draw(begin, end);
            begin = end;
        }
    }
}

}  // namespace gyrolog
