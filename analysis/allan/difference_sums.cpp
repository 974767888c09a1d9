#include "analysis/allan/difference_sums.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "analysis/parallel/parallel_for.hpp"

#if defined(__x86_64__) && !defined(GYROLOG_BASELINE_INSTRUCTIONS)
    #include <immintrin.h>
#endif

namespace gyrolog {
namespace {

// Blocks outside, averaging factors inside: a block's theta_k stay in the first-level cache for all m, and
// while 2m points fit into a further level, so do the others.
constexpr std::size_t block_terms = 2048;
// What one thread takes at a time: terms of one stretch, for so many factors.
constexpr std::size_t task_terms = 8 * block_terms;
constexpr std::size_t task_factors = 1024;

// 128 bits. A second difference of n samples of 16 bits is below 2^16 n, so that its square summed n times is
// below 2^32 n^3: no record of up to 2^32 samples overflows.
__extension__ using WideSum = unsigned __int128;

template <typename T>
[[gnu::always_inline]] inline T second_difference(const T* theta, std::size_t m) {
    return (theta[2 * m] - theta[m]) - (theta[m] - theta[0]);
}

[[gnu::always_inline]] inline std::uint64_t square(std::int32_t x) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(x) * static_cast<std::int64_t>(x));
}

// 32-bit differences below 2^26: the squares of a block sum to less than 2^64.
struct NarrowSquares {
    using Total = WideSum;
    static constexpr std::int64_t limit = std::int64_t{1} << 26U;
    static_assert(block_terms <= std::size_t{1} << 12U);

    [[gnu::always_inline]] static WideSum sum(const std::int32_t* theta, std::size_t count, std::size_t m) {
        std::uint64_t sum = 0;
        for (std::size_t k = 0; k < count; ++k) { sum += square(second_difference(theta + k, m)); }
        return sum;
    }
};

// Any 32-bit difference: a square is at most 2^62, and its upper and lower 32 bits are summed apart.
struct SplitSquares {
    using Total = WideSum;
    [[gnu::always_inline]] static WideSum sum(const std::int32_t* theta, std::size_t count, std::size_t m) {
        constexpr unsigned half_bits = 32;
        std::uint64_t low = 0;
        std::uint64_t high = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint64_t x = square(second_difference(theta + k, m));
            low += static_cast<std::uint32_t>(x);
            high += x >> half_bits;
        }
        return (static_cast<WideSum>(high) << half_bits) + low;
    }
};

struct WideSquares {
    using Total = WideSum;
    [[gnu::always_inline]] static WideSum sum(const std::int64_t* theta, std::size_t count, std::size_t m) {
        WideSum sum = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::int64_t d = second_difference(theta + k, m);
            const auto magnitude = static_cast<std::uint64_t>(d < 0 ? -d : d);
            sum += static_cast<WideSum>(magnitude) * magnitude;
        }
        return sum;
    }
};

// Independent sums in fixed lanes: the compiler may use any vector width without changing a bit of the
// result.
struct RealSquares {
    using Total = double;
    [[gnu::always_inline]] static double sum(const double* theta, std::size_t count, std::size_t m) {
        constexpr std::size_t lanes = 16;
        std::array<double, lanes> sums{};
        std::size_t k = 0;
        for (; k + lanes <= count; k += lanes) {
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                const double d = second_difference(theta + k + lane, m);
                sums[lane] += d * d;
            }
        }
        for (std::size_t lane = 0; k < count; ++k, ++lane) {
            const double d = second_difference(theta + k, m);
            sums[lane] += d * d;
        }
        for (std::size_t width = lanes / 2; width > 0; width /= 2) {
            for (std::size_t lane = 0; lane < width; ++lane) { sums[lane] += sums[lane + width]; }
        }
        return sums[0];
    }
};

#if defined(__x86_64__) && !defined(GYROLOG_BASELINE_INSTRUCTIONS)
template <typename Squares, typename T>
[[gnu::target("avx2")]] typename Squares::Total sum_avx2(const T* theta, std::size_t count, std::size_t m) {
    return Squares::sum(theta, count, m);
}

// Loads are what limits this loop; the one that compilers make of sum() adds three shuffles to every eight
// terms.
template <>
[[gnu::target("avx2")]] WideSum sum_avx2<NarrowSquares>(const std::int32_t* theta, std::size_t count,
                                                        std::size_t m) {
    constexpr std::size_t lanes = 8;
    const auto at = [](const std::int32_t* p) { return reinterpret_cast<const __m256i*>(p); };
    __m256i even = _mm256_setzero_si256();
    __m256i odd = _mm256_setzero_si256();
    std::size_t k = 0;
    // Once a turn, it is a fifth slower where the linker happens to put it at the beginning of a cache line.
    #pragma GCC unroll 4
    for (; k + lanes <= count; k += lanes) {
        const __m256i first = _mm256_loadu_si256(at(theta + k));
        const __m256i middle = _mm256_loadu_si256(at(theta + k + m));
        const __m256i last = _mm256_loadu_si256(at(theta + k + 2 * m));
        const __m256i d = _mm256_sub_epi32(_mm256_add_epi32(first, last), _mm256_add_epi32(middle, middle));
        const __m256i upper = _mm256_srli_epi64(d, 32);
        even = _mm256_add_epi64(even, _mm256_mul_epi32(d, d));
        odd = _mm256_add_epi64(odd, _mm256_mul_epi32(upper, upper));
    }
    std::array<std::uint64_t, 4> sums{};
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(sums.data()), _mm256_add_epi64(even, odd));
    return std::accumulate(sums.begin(), sums.end(), std::uint64_t{0}) +
           NarrowSquares::sum(theta + k, count - k, m);
}
#endif

template <typename Squares, typename T>
typename Squares::Total sum_block(const T* theta, std::size_t count, std::size_t m) {
#if defined(__x86_64__) && !defined(GYROLOG_BASELINE_INSTRUCTIONS)
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    if (has_avx2) { return sum_avx2<Squares>(theta, count, m); }
#endif
    return Squares::sum(theta, count, m);
}

struct Sum {
    WideSum counts = 0;
    double reals = 0.0;

    void add(WideSum squares) { counts += squares; }
    void add(double squares) { reals += squares; }
};

struct Task {
    const Stretch* stretch = nullptr;
    std::size_t begin = 0;
};

template <typename Squares, typename T>
void add_task(std::span<const T> theta, std::size_t begin, std::span<const std::int64_t> factors, Sum* sums) {
    const std::size_t end = std::min(begin + task_terms, theta.size());
    for (std::size_t at = begin; at < end; at += block_terms) {
        for (std::size_t f = 0; f < factors.size(); ++f) {
            const auto m = static_cast<std::size_t>(factors[f]);
            if (at + 2 * m >= theta.size()) { continue; }
            const std::size_t count = std::min({block_terms, end - at, theta.size() - 2 * m - at});
            sums[f].add(sum_block<Squares>(theta.data() + at, count, m));
        }
    }
}

void add_task(const Task& task, std::span<const std::int64_t> factors, Sum* sums) {
    const PrefixSum& theta = task.stretch->theta;
    if (const auto* reals = std::get_if<std::vector<double>>(&theta.values())) {
        add_task<RealSquares, double>(*reals, task.begin, factors, sums);
    } else if (const auto* wide = std::get_if<std::vector<std::int64_t>>(&theta.values())) {
        add_task<WideSquares, std::int64_t>(*wide, task.begin, factors, sums);
    } else {
        const auto& narrow = std::get<std::vector<std::int32_t>>(theta.values());
        if (2 * theta.spread() < NarrowSquares::limit) {
            add_task<NarrowSquares, std::int32_t>(narrow, task.begin, factors, sums);
        } else {
            add_task<SplitSquares, std::int32_t>(narrow, task.begin, factors, sums);
        }
    }
}

void sum_factors(std::span<const Task> tasks, std::span<const std::int64_t> factors, unsigned threads,
                 double* results) {
    std::vector<Sum> partial(tasks.size() * factors.size());
    parallel_for(tasks.size(), threads,
                 [&](std::size_t t) { add_task(tasks[t], factors, partial.data() + t * factors.size()); });
    for (std::size_t f = 0; f < factors.size(); ++f) {
        Sum sum;
        for (std::size_t t = 0; t < tasks.size(); ++t) {
            sum.add(partial[t * factors.size() + f].counts);
            sum.add(partial[t * factors.size() + f].reals);
        }
        results[f] = static_cast<double>(sum.counts) + sum.reals;
    }
}

}  // namespace

std::vector<double> sums_of_squared_differences(std::span<const Stretch> stretches,
                                                std::span<const std::int64_t> m, unsigned threads) {
    std::vector<Task> tasks;
    for (const Stretch& stretch : stretches) {
        for (std::size_t begin = stretch.begin; begin < stretch.theta.points(); begin += task_terms) {
            tasks.push_back({&stretch, begin});
        }
    }
    std::vector<double> sums(m.size());
    for (std::size_t first = 0; first < m.size(); first += task_factors) {
        const auto factors = m.subspan(first, std::min(task_factors, m.size() - first));
        sum_factors(tasks, factors, threads, sums.data() + first);
    }
    return sums;
}

}  // namespace gyrolog
