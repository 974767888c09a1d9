#include "analysis/allan/power_law.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <boost/math/quadrature/gauss.hpp>

namespace gyrolog {
namespace {

constexpr std::size_t index_of(PowerLaw law) { return static_cast<std::size_t>(law); }

double t2_log_t(double t) { return t == 0.0 ? 0.0 : t * t * std::log(std::abs(t)); }

// Generalised autocovariance of the angle at lag t (unit: m samples), up to a factor. White rate noise makes
// the angle a random walk; each integration more raises the power of t by two.
double angle_covariance(PowerLaw law, double t) {
    switch (law) {
        case PowerLaw::white_rate:
            return -std::abs(t);
        case PowerLaw::flicker_rate:
            return t2_log_t(t);
        case PowerLaw::rate_walk:
            return std::abs(t * t * t);
        default:
            return 0.0;
    }
}

// Flicker of the angle has no limit for continuous time: it is averaged over one sample. Lag in samples.
double flicker_angle_covariance(double lag) {
    const double j = std::abs(lag);
    if (j > 1000.0) { return -2.0 * std::log(j) - 3.0 + 1.0 / (6.0 * j * j); }
    return 2.0 * t2_log_t(j) - t2_log_t(j - 1.0) - t2_log_t(j + 1.0);
}

// The fourth difference that takes a covariance of the angle to one of its second differences, over spacing
// h.
template <typename Covariance>
double fourth_difference(const Covariance& covariance, double t, double h) {
    return 6.0 * covariance(t) - 4.0 * (covariance(t - h) + covariance(t + h)) + covariance(t - 2.0 * h) +
           covariance(t + 2.0 * h);
}

double correlation(PowerLaw law, double lag, double m) {
    if (law == PowerLaw::white_angle) {
        const double j = std::abs(lag);
        if (j == 0.0) { return 1.0; }
        if (j == m) { return -4.0 / 6.0; }
        return j == 2.0 * m ? 1.0 / 6.0 : 0.0;
    }
    if (law == PowerLaw::flicker_angle) {
        return fourth_difference(flicker_angle_covariance, lag, m) /
               fourth_difference(flicker_angle_covariance, 0.0, m);
    }
    const auto covariance = [&](double t) { return angle_covariance(law, t); };
    return fourth_difference(covariance, lag / m, 1.0) / fourth_difference(covariance, 0.0, 1.0);
}

// Sums over lags of products rho_a rho_b, for pairs of the laws wanted.
class LagSums {
public:
    LagSums(std::span<const PowerLaw> laws, std::int64_t m) : laws_(laws), m_(m) {}

    void add(double lag, double weight) {
        std::array<double, power_laws> rho{};
        for (const PowerLaw law : laws_) {
            rho[index_of(law)] = correlation(law, lag, static_cast<double>(m_));
        }
        for (const PowerLaw a : laws_) {
            for (const PowerLaw b : laws_) {
                sums_[index_of(a)][index_of(b)] += weight * rho[index_of(a)] * rho[index_of(b)];
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
            using Gauss = boost::math::quadrature::gauss<double, 7>;
            const double half = static_cast<double>(length) / 2.0;
            const double centre = static_cast<double>(lag) - 0.5 + half;
            for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
                const double x = Gauss::abscissa()[i];
                const double width = half * Gauss::weights()[i];
                add_one(centre + half * x, width);
                if (x != 0.0) { add_one(centre - half * x, width); }
            }
            lag += length;
        }
    }

    const auto& sums() const { return sums_; }

private:
    std::span<const PowerLaw> laws_;
    std::int64_t m_;
    std::array<std::array<double, power_laws>, power_laws> sums_{};
};

// White angle noise has correlation at two single lags, which pieces would miss.
void add_white_angle_lags(LagSums& lags, std::int64_t m, std::int64_t last, double terms) {
    for (const std::int64_t lag : {m, 2 * m}) {
        if (lag <= last) {
            lags.add(static_cast<double>(lag), 2.0 * (1.0 - static_cast<double>(lag) / terms));
        }
    }
}

std::vector<double> differences(std::span<const double> x) {
    std::vector<double> d;
    for (std::size_t i = 1; i < x.size(); ++i) { d.push_back(x[i] - x[i - 1]); }
    return d;
}

struct Spread {
    double mean = 0.0;
    double squares = 0.0;     // sum of squared deviations from the mean
    double neighbours = 0.0;  // sum of products of neighbouring deviations
    std::size_t count = 0;
};

Spread spread_of(std::span<const double> x) {
    Spread spread;
    for (const double value : x) {
        if (std::isnan(value)) { continue; }
        spread.mean += value;
        ++spread.count;
    }
    if (spread.count == 0) { return spread; }
    spread.mean /= static_cast<double>(spread.count);
    double before = std::nan("");
    for (const double value : x) {
        const double off = value - spread.mean;
        if (!std::isnan(off)) { spread.squares += off * off; }
        if (!std::isnan(off * before)) { spread.neighbours += off * before; }
        before = off;
    }
    return spread;
}

// The exponent alpha of the rate's spectrum f^alpha.
std::optional<double> exponent_by_autocorrelation(std::span<const double> averages) {
    std::vector<double> x(averages.begin(), averages.end());
    for (int order = 0;; ++order) {
        const Spread spread = spread_of(x);
        if (spread.squares <= 0.0) { return std::nullopt; }
        const double r = spread.neighbours / spread.squares;
        const double delta = r / (1.0 + r);
        if (delta < 0.25 || order == 1) { return -2.0 * (delta + order); }
        x = differences(x);
    }
}

// B1: expected ratio of the sample variance of n averages to their Allan variance (Barnes 1969).
double b1(double n, PowerLaw law) {
    switch (law) {
        case PowerLaw::white_angle:
        case PowerLaw::flicker_angle:
            return (n + 1.0) / (1.5 * n);
        case PowerLaw::white_rate:
            return 1.0;
        case PowerLaw::flicker_rate:
            return n * std::log(n) / (2.0 * (n - 1.0) * std::log(2.0));
        case PowerLaw::rate_walk:
            return n / 2.0;
    }
    return 1.0;
}

std::optional<PowerLaw> law_by_b1(std::span<const double> averages) {
    const Spread spread = spread_of(averages);
    double squares = 0.0;
    std::size_t pairs = 0;
    for (const double d : differences(averages)) {
        if (std::isnan(d)) { continue; }
        squares += d * d;
        ++pairs;
    }
    if (pairs < 2 || squares <= 0.0) { return std::nullopt; }
    const auto n = static_cast<double>(spread.count);
    const double ratio = spread.squares / (n - 1.0) / (squares / (2.0 * static_cast<double>(pairs)));
    // White and flicker angle have one B1; the first is by far the commoner, and the interval hardly differs.
    constexpr std::array laws = {PowerLaw::white_angle, PowerLaw::white_rate, PowerLaw::flicker_rate,
                                 PowerLaw::rate_walk};
    for (std::size_t i = 0; i + 1 < laws.size(); ++i) {
        if (ratio < std::sqrt(b1(n, laws[i]) * b1(n, laws[i + 1]))) { return laws[i]; }
    }
    return PowerLaw::rate_walk;
}

}  // namespace

std::optional<PowerLaw> identify_power_law(std::span<const double> averages) {
    const auto count = std::ranges::count_if(averages, [](double x) { return !std::isnan(x); });
    if (count < 4) { return std::nullopt; }
    if (count < 30) { return law_by_b1(averages); }
    const std::optional<double> alpha = exponent_by_autocorrelation(averages);
    if (!alpha) { return std::nullopt; }
    return static_cast<PowerLaw>(std::lround(2.0 - std::clamp(*alpha, -2.0, 2.0)));
}

DegreesOfFreedom::DegreesOfFreedom(std::span<const PowerLaw> laws, std::int64_t m, std::int64_t stride,
                                   std::span<const std::int64_t> terms_of_runs) {
    const bool white_angle_only = laws.size() == 1 && laws.front() == PowerLaw::white_angle;
    for (const std::int64_t run : terms_of_runs) {
        if (run <= 0) { continue; }
        const auto count = static_cast<double>(run);
        const std::int64_t last = std::min(run - 1, 4 * m / stride);
        LagSums lags(laws, m);
        lags.add(0.0, 1.0);
        if (white_angle_only && stride == 1) {
            add_white_angle_lags(lags, m, last, count);
        } else if (stride == 1 && m > 64) {
            lags.add_lags(last, count);
        } else {
            for (std::int64_t j = 1; j <= last; ++j) {
                lags.add(static_cast<double>(j * stride), 2.0 * (1.0 - static_cast<double>(j) / count));
            }
        }
        terms_ += count;
        for (std::size_t a = 0; a < power_laws; ++a) {
            for (std::size_t b = 0; b < power_laws; ++b) { products_[a][b] += count * lags.sums()[a][b]; }
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
