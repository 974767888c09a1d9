#include "analysis/allan/deviation_sums.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <type_traits>

#include "analysis/parallel/parallel_for.hpp"

namespace gyrolog {
namespace {

// Differences of whole numbers are taken in 64 bits, where they are exact.
template <typename T>
using Exact = std::conditional_t<std::integral<T>, std::int64_t, double>;

template <typename T>
Exact<T> exact_second_difference(const T* theta, std::size_t m) {
    using E = Exact<T>;
    return (E{theta[2 * m]} - E{theta[m]}) - (E{theta[m]} - E{theta[0]});
}

template <typename T>
Exact<T> third_difference(const T* theta, std::size_t m) {
    return exact_second_difference(theta + m, m) - exact_second_difference(theta, m);
}

// Sum of squares in fixed lanes: the same bits with any vector width, and a shorter chain of roundings.
class Squares {
public:
    void add(double x) {
        lanes_[next_] += x * x;
        next_ = (next_ + 1) % lanes_.size();
    }
    double sum() const {
        return ((lanes_[0] + lanes_[1]) + (lanes_[2] + lanes_[3])) +
               ((lanes_[4] + lanes_[5]) + (lanes_[6] + lanes_[7]));
    }

private:
    std::array<double, 8> lanes_{};
    std::size_t next_ = 0;
};

template <typename T, typename Difference>
double strided_squares(const T* theta, const TermRun& run, std::int64_t stride,
                       const Difference& difference) {
    Squares squares;
    for (std::int64_t j = 0; j < run.terms; ++j) {
        squares.add(static_cast<double>(difference(theta + run.begin + j * stride)));
    }
    return squares.sum();
}

// Sum of a window of m neighbouring second differences that moves on by one: what enters and what leaves
// together are a third difference. The roundings are summed beside it (Knuth's two-sum), lest they grow with
// the length of the record.
class MovingSum {
public:
    void add(double x) {
        const double next = sum_ + x;
        const double added = next - sum_;
        lost_ += (sum_ - (next - added)) + (x - added);
        sum_ = next;
    }
    double value() const { return sum_ + lost_; }

private:
    double sum_ = 0.0;
    double lost_ = 0.0;
};

// Exact: |second difference| of 32-bit points fits 32 bits (prefix_sum.hpp), and m of them 63.
class WholeMovingSum {
public:
    void add(std::int64_t x) { sum_ += x; }
    double value() const { return static_cast<double>(sum_); }

private:
    std::int64_t sum_ = 0;
};

template <typename Sum, typename T>
double window_squares(const T* theta, const TermRun& run, std::size_t m) {
    using Number = std::conditional_t<std::same_as<Sum, WholeMovingSum>, std::int64_t, double>;
    Sum window;
    for (std::size_t i = 0; i < m; ++i) {
        window.add(static_cast<Number>(exact_second_difference(theta + run.begin + i, m)));
    }
    Squares squares;
    squares.add(window.value());
    for (std::int64_t j = 1; j < run.terms; ++j) {
        window.add(static_cast<Number>(third_difference(theta + run.begin + j - 1, m)));
        squares.add(window.value());
    }
    return squares.sum();
}

// Terms whose outer points lie beyond an end of theta: theta*_{-j} = 2 theta_0 - theta_j, and alike at the
// other end. All others are the overlapping ones.
template <typename T>
double reflected_squares(const T* theta, std::int64_t begin, std::int64_t points, std::int64_t m) {
    using E = Exact<T>;
    const T* const first = theta + begin;
    const T* const last = theta + points - 1;
    Squares squares;
    for (std::int64_t i = 1; i < m; ++i) {
        const E left = (E{first[i + m]} - E{first[i]}) - (E{first[i]} - (2 * E{first[0]} - E{first[m - i]}));
        const E right = (E{last[-i - m]} - E{last[-i]}) - (E{last[-i]} - (2 * E{last[0]} - E{last[i - m]}));
        squares.add(static_cast<double>(left));
        squares.add(static_cast<double>(right));
    }
    return squares.sum();
}

double squares_of(const IntegratedSignal& signal, const DeviationRule& rule, std::size_t stretch,
                  std::int64_t factor) {
    const TermRun run = run_of(rule, signal.segments, stretch, signal.convention, factor);
    if (run.terms == 0) { return 0.0; }
    const auto m = static_cast<std::size_t>(factor);
    return std::visit(
        [&](const auto& theta) {
            using T = std::remove_cvref_t<decltype(theta[0])>;
            const T* const data = theta.data();
            if (rule.reflected) {
                return reflected_squares(data, run.begin, static_cast<std::int64_t>(theta.size()), factor);
            }
            if (rule.window_mean) {
                using Sum = std::conditional_t<std::same_as<T, std::int32_t>, WholeMovingSum, MovingSum>;
                return window_squares<Sum>(data, run, m);
            }
            if (rule.order == 3) {
                return strided_squares(data, run, rule.stride(factor),
                                       [m](const T* at) { return third_difference(at, m); });
            }
            return strided_squares(data, run, rule.stride(factor),
                                   [m](const T* at) { return exact_second_difference(at, m); });
        },
        signal.stretches[stretch].theta.values());
}

}  // namespace

IntegratedSignal::IntegratedSignal(const Column& column, std::span<const Segment> of, PhaseConvention phase)
    : segments(of), convention(phase) {
    const double centre = raw_mean(column);
    for (const Segment& segment : segments) {
        stretches.push_back({PrefixSum(column, centre, segment.first, segment.count),
                             convention == PhaseConvention::matlab ? std::size_t{1} : std::size_t{0}});
    }
}

std::vector<double> deviation_sums(const IntegratedSignal& signal, const DeviationRule& rule,
                                   std::span<const std::int64_t> m, unsigned threads) {
    const bool plain = rule.overlapping && rule.order == 2 && !rule.window_mean;
    std::vector<double> sums =
        plain ? sums_of_squared_differences(signal.stretches, m, threads) : std::vector<double>(m.size());
    if (plain && !rule.reflected) { return sums; }
    parallel_for(m.size(), threads, [&](std::size_t f) {
        for (std::size_t s = 0; s < signal.stretches.size(); ++s) {
            sums[f] += squares_of(signal, rule, s, m[f]);
        }
    });
    return sums;
}

}  // namespace gyrolog
