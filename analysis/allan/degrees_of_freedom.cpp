#include "analysis/allan/degrees_of_freedom.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/allan/difference_covariance.hpp"
#include "analysis/allan/total_variance.hpp"
#include "analysis/numerics/legendre_rule.hpp"

namespace gyrolog {
namespace {

// Sums over lags of products rho_a rho_b, for pairs of the laws wanted.
class LagSums {
public:
    LagSums(std::span<const PowerLaw> laws, const DeviationRule& rule, std::int64_t m) : m_(m) {
        for (const PowerLaw law : laws) {
            noises_.push_back({index_of(law), DifferenceCovariance(law, rule, m)});
        }
    }

    void add(double lag, double weight) {
        std::array<double, power_laws> rho{};
        for (const Noise& noise : noises_) { rho[noise.index] = noise.covariance.correlation(lag); }
        for (const Noise& a : noises_) {
            for (const Noise& b : noises_) {
                sums_[a.index][b.index] += weight * rho[a.index] * rho[b.index];
            }
        }
    }

    // Lags 1 ... last, each with the weight 2 (1 - lag / terms). Near the multiples of m, where rho has its
    // corners, lag by lag; between, where it is smooth, as integrals over pieces that double in length away
    // from the corners.
    void add_lags(std::int64_t last, double terms) {
        constexpr std::int64_t near = 12;
        const auto add_one = [&](double lag, double width) { add(lag, 2.0 * width * (1.0 - lag / terms)); };
        std::int64_t lag = 1;
        while (lag <= last) {
            const std::int64_t below = lag / m_ * m_;
            const std::int64_t corner = (lag + m_ / 2) / m_ * m_;
            // A piece may be as long as it is far from the corners on both sides.
            const std::int64_t to_next = below + m_ - near - lag;
            const std::int64_t length = std::min(std::min(lag - below, (to_next + 1) / 2), last + 1 - lag);
            if (std::abs(lag - corner) <= near || length <= 6) {
                add_one(static_cast<double>(lag), 1.0);
                ++lag;
                continue;
            }
            const double half = static_cast<double>(length) / 2.0;
            const double centre = static_cast<double>(lag) - 0.5 + half;
            for (const auto& [x, weight] : legendre_rule_of_seven()) {
                const double width = half * weight;
                add_one(centre + half * x, width);
                if (x != 0.0) { add_one(centre - half * x, width); }
            }
            lag += length;
        }
    }

    const auto& sums() const { return sums_; }

private:
    struct Noise {
        std::size_t index = 0;
        DifferenceCovariance covariance;
    };
    std::vector<Noise> noises_;
    std::int64_t m_;
    std::array<std::array<double, power_laws>, power_laws> sums_{};
};

LagSums overlapping_lags(std::span<const PowerLaw> laws, const DeviationRule& rule, std::int64_t m,
                         std::int64_t terms) {
    constexpr std::int64_t lag_by_lag = 64;
    const auto count = static_cast<double>(terms);
    const std::int64_t stride = rule.stride(m);
    const std::int64_t last = std::min(terms - 1, (rule.order + 2) * m / stride);
    LagSums lags(laws, rule, m);
    lags.add(0.0, 1.0);
    if (stride == 1 && m > lag_by_lag) {
        lags.add_lags(last, count);
        return lags;
    }
    for (std::int64_t j = 1; j <= last; ++j) {
        lags.add(static_cast<double>(j * stride), 2.0 * (1.0 - static_cast<double>(j) / count));
    }
    return lags;
}

// For each law, by how much reflection shortens the sum over lags of overlapping differences. The published
// table is that of long averages: at small m, by how much it would shorten it at 64 samples for the same T /
// tau.
std::array<double, power_laws> shortening_by_reflection(std::span<const PowerLaw> laws,
                                                        const DeviationRule& rule, std::int64_t m,
                                                        std::int64_t terms) {
    constexpr std::int64_t long_enough = 64;
    const std::int64_t scale = m < long_enough ? (long_enough + m - 1) / m : 1;
    std::array<double, power_laws> factors{};
    factors.fill(1.0);
    for (const PowerLaw law : laws) {
        const bool angle = law == PowerLaw::white_angle || law == PowerLaw::flicker_angle;
        const std::int64_t long_m = angle ? m : m * scale;
        const std::int64_t long_terms = angle ? terms : (terms + 1) * scale - 1;
        const std::int64_t inside = std::max<std::int64_t>(1, long_terms + 2 - 2 * long_m);
        const LagSums lags = overlapping_lags(std::array{law}, rule, long_m, inside);
        const double length = lags.sums()[index_of(law)][index_of(law)];
        const double overlapping_edf = static_cast<double>(inside) / length;
        factors[index_of(law)] = overlapping_edf / total_edf(law, long_terms, long_m, overlapping_edf);
    }
    return factors;
}

}  // namespace

DegreesOfFreedom::DegreesOfFreedom(std::span<const PowerLaw> laws, const DeviationRule& rule, std::int64_t m,
                                   std::span<const std::int64_t> terms_of_runs) {
    for (const std::int64_t terms : terms_of_runs) {
        if (terms <= 0) { continue; }
        const std::int64_t inside = rule.reflected ? std::max<std::int64_t>(1, terms + 2 - 2 * m) : terms;
        const LagSums lags = overlapping_lags(laws, rule, m, inside);
        std::array<double, power_laws> factor{};
        factor.fill(1.0);
        if (rule.reflected) { factor = shortening_by_reflection(laws, rule, m, terms); }
        const auto count = static_cast<double>(inside);
        terms_ += count;
        for (std::size_t a = 0; a < power_laws; ++a) {
            for (std::size_t b = 0; b < power_laws; ++b) {
                products_[a][b] += count * lags.sums()[a][b] * std::sqrt(factor[a] * factor[b]);
            }
        }
    }
}

double DegreesOfFreedom::of(const VarianceShares& shares) const {
    double total = 0.0;
    double sum = 0.0;
    for (std::size_t a = 0; a < power_laws; ++a) {
        total += shares[a];
        for (std::size_t b = 0; b < power_laws; ++b) { sum += shares[a] * shares[b] * products_[a][b]; }
    }
    return sum > 0.0 ? terms_ * terms_ * total * total / sum : 0.0;
}

double DegreesOfFreedom::of(PowerLaw law) const {
    VarianceShares shares{};
    shares[index_of(law)] = 1.0;
    return of(shares);
}

}  // namespace gyrolog
