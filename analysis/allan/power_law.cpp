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

class Correlation {
public:
    Correlation(const VarianceShares& shares, std::int64_t m) : shares_(shares), m_(static_cast<double>(m)) {
        double total = 0.0;
        for (const double share : shares_) { total += share; }
        for (double& share : shares_) { share /= total; }
    }

    double squared(double lag) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < power_laws; ++i) {
            if (shares_[i] != 0.0) { sum += shares_[i] * correlation(static_cast<PowerLaw>(i), lag, m_); }
        }
        return sum * sum;
    }

private:
    VarianceShares shares_;
    double m_;
};

// Sum over lags 1 ... last of (1 - lag / terms) rho^2. Near the multiples of m, where rho has its corners,
// lag by lag; between, where it is smooth, as integrals over pieces that double in length away from the
// corners.
double sum_over_lags(const Correlation& rho, std::int64_t m, std::int64_t last, double terms) {
    constexpr std::int64_t near = 48;
    const auto term = [&](double lag) { return (1.0 - lag / terms) * rho.squared(lag); };
    double sum = 0.0;
    std::int64_t lag = 1;
    while (lag <= last) {
        const std::int64_t corner = (lag + m / 2) / m * m;
        if (std::abs(lag - corner) <= near) {
            sum += term(static_cast<double>(lag));
            ++lag;
            continue;
        }
        // A piece may be as long as it is far from the corners on both sides.
        const std::int64_t below = lag / m * m;
        const std::int64_t to_next = below + m - near - lag;
        const std::int64_t far = std::max<std::int64_t>(1, std::min(lag - below, (to_next + 1) / 2));
        const std::int64_t end = std::min(last + 1, lag + far);
        if (end - lag <= 8) {
            for (; lag < end; ++lag) { sum += term(static_cast<double>(lag)); }
        } else {
            sum += boost::math::quadrature::gauss<double, 7>::integrate(term, static_cast<double>(lag) - 0.5,
                                                                        static_cast<double>(end) - 0.5);
            lag = end;
        }
    }
    return sum;
}

// Sum over all lags j, |j| < terms, of (1 - |j| / terms) rho(j stride)^2.
double squared_correlation(const Correlation& rho, bool white_angle_only, std::int64_t m, std::int64_t stride,
                           std::int64_t terms) {
    const auto count = static_cast<double>(terms);
    const auto term = [&](std::int64_t j) {
        return (1.0 - static_cast<double>(j) / count) * rho.squared(static_cast<double>(j * stride));
    };
    const std::int64_t last = std::min(terms - 1, 4 * m / stride);
    double sum = 0.0;
    if (white_angle_only && stride == 1) {  // only two lags are not zero
        for (const std::int64_t j : {m, 2 * m}) {
            if (j <= last) { sum += term(j); }
        }
    } else if (stride == 1 && m > 256) {
        sum = sum_over_lags(rho, m, last, count);
    } else {
        for (std::int64_t j = 1; j <= last; ++j) { sum += term(j); }
    }
    return 1.0 + 2.0 * sum;
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

VarianceShares shares_of(PowerLaw law) {
    VarianceShares shares{};
    shares[index_of(law)] = 1.0;
    return shares;
}

std::optional<PowerLaw> identify_power_law(std::span<const double> averages) {
    const auto count = std::ranges::count_if(averages, [](double x) { return !std::isnan(x); });
    if (count < 4) { return std::nullopt; }
    if (count < 30) { return law_by_b1(averages); }
    const std::optional<double> alpha = exponent_by_autocorrelation(averages);
    if (!alpha) { return std::nullopt; }
    return static_cast<PowerLaw>(std::lround(2.0 - std::clamp(*alpha, -2.0, 2.0)));
}

double equivalent_degrees_of_freedom(const VarianceShares& shares, std::int64_t m, std::int64_t stride,
                                     std::span<const std::int64_t> terms_of_runs) {
    const Correlation rho(shares, m);
    double others = 0.0;
    for (std::size_t i = 1; i < power_laws; ++i) { others += shares[i]; }
    double terms = 0.0;
    double weight = 0.0;
    for (const std::int64_t run : terms_of_runs) {
        if (run <= 0) { continue; }
        const auto count = static_cast<double>(run);
        terms += count;
        weight += count * squared_correlation(rho, others == 0.0, m, stride, run);
    }
    return weight > 0.0 ? terms * terms / weight : 0.0;
}

}  // namespace gyrolog
