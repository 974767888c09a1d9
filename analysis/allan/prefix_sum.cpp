#include "analysis/allan/prefix_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace gyrolog {
namespace {

template <typename T>
struct ExactSums {
    std::vector<T> theta;  // modulo the width of T
    std::int64_t spread = 0;
};

template <typename T>
ExactSums<T> exact_sums(std::span<const std::int16_t> counts, std::int64_t centre) {
    ExactSums<T> sums{std::vector<T>(counts.size() + 1)};
    std::int64_t sum = 0;
    std::int64_t low = 0;
    std::int64_t high = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        sum += counts[i] - centre;
        low = std::min(low, sum);
        high = std::max(high, sum);
        sums.theta[i + 1] = static_cast<T>(sum);
    }
    sums.spread = high - low;
    return sums;
}

// |theta_{k+2m} - 2 theta_{k+m} + theta_k| <= 2 (max theta - min theta), and theta itself, which begins at 0,
// is within that too.
bool second_differences_fit_32_bits(std::int64_t spread) {
    return 2 * spread <= std::numeric_limits<std::int32_t>::max();
}

class CompensatedSum {
public:
    void add(double x) {
        const double next = sum_ + x;
        lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - next) + x : (x - next) + sum_;
        sum_ = next;
    }
    double value() const { return sum_ + lost_; }

private:
    double sum_ = 0.0;
    double lost_ = 0.0;
};

std::vector<double> compensated_sums(std::span<const double> x, double centre) {
    std::vector<double> theta(x.size() + 1);
    CompensatedSum sum;
    for (std::size_t i = 0; i < x.size(); ++i) {
        sum.add(x[i] - centre);
        theta[i + 1] = sum.value();
    }
    return theta;
}

}  // namespace

double raw_mean(const Column& column) {
    if (column.size() == 0) { return 0.0; }
    const auto samples = static_cast<double>(column.size());
    if (const auto* counts = std::get_if<std::vector<std::int16_t>>(&column.data)) {
        return static_cast<double>(std::accumulate(counts->begin(), counts->end(), std::int64_t{0})) /
               samples;
    }
    CompensatedSum sum;
    for (const double x : std::get<std::vector<double>>(column.data)) { sum.add(x); }
    return sum.value() / samples;
}

PrefixSum::PrefixSum(const Column& column, double centre, std::size_t first, std::size_t count) {
    if (const auto* reals = std::get_if<std::vector<double>>(&column.data)) {
        theta_ = compensated_sums(std::span(*reals).subspan(first, count), centre);
        return;
    }
    const auto counts = std::span(std::get<std::vector<std::int16_t>>(column.data)).subspan(first, count);
    const std::int64_t whole = std::llround(centre);
    auto narrow = exact_sums<std::int32_t>(counts, whole);
    spread_ = narrow.spread;
    if (second_differences_fit_32_bits(spread_)) {
        theta_ = std::move(narrow.theta);
    } else {
        theta_ = exact_sums<std::int64_t>(counts, whole).theta;
    }
}

std::size_t PrefixSum::points() const {
    return std::visit([](const auto& theta) { return theta.size(); }, theta_);
}

double PrefixSum::operator[](std::size_t k) const {
    return std::visit([&](const auto& theta) { return static_cast<double>(theta[k]); }, theta_);
}

}  // namespace gyrolog
