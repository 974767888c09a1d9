#include "analysis/allan/prefix_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gyrolog {
namespace {

template <typename T>
std::vector<T> exact_sums(std::span<const std::int16_t> counts, std::int64_t centre) {
    std::vector<T> theta(counts.size() + 1);
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        sum += counts[i] - centre;
        theta[i + 1] = static_cast<T>(sum);
    }
    return theta;
}

// |theta_{k+2m} - 2 theta_{k+m} + theta_k| <= 2 (max theta - min theta).
bool second_differences_fit_32_bits(std::span<const std::int16_t> counts, std::int64_t centre) {
    std::int64_t sum = 0;
    std::int64_t low = 0;
    std::int64_t high = 0;
    for (const std::int16_t x : counts) {
        sum += x - centre;
        low = std::min(low, sum);
        high = std::max(high, sum);
    }
    return 2 * (high - low) <= std::numeric_limits<std::int32_t>::max();
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
    CompensatedSum sum;
    std::visit(
        [&](const auto& data) {
            for (const auto x : data) { sum.add(x); }
        },
        column.data);
    return sum.value() / static_cast<double>(column.size());
}

PrefixSum::PrefixSum(const Column& column, double centre, std::size_t first, std::size_t count) {
    if (const auto* reals = std::get_if<std::vector<double>>(&column.data)) {
        theta_ = compensated_sums(std::span(*reals).subspan(first, count), centre);
        return;
    }
    const auto counts = std::span(std::get<std::vector<std::int16_t>>(column.data)).subspan(first, count);
    const std::int64_t whole = std::llround(centre);
    if (second_differences_fit_32_bits(counts, whole)) {
        theta_ = exact_sums<std::int32_t>(counts, whole);
    } else {
        theta_ = exact_sums<std::int64_t>(counts, whole);
    }
}

std::size_t PrefixSum::points() const {
    return std::visit([](const auto& theta) { return theta.size(); }, theta_);
}

double PrefixSum::operator[](std::size_t k) const {
    return std::visit([&](const auto& theta) { return static_cast<double>(theta[k]); }, theta_);
}

}  // namespace gyrolog
