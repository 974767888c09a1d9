#include "analysis/allan/difference_sums.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

namespace gyrolog {
namespace {

// Blocks outside, averaging factors inside: while 2m points more than a block fit into the second-level
// cache, theta comes from memory once for all those m. 16384 32-bit points are 64 KiB.
constexpr std::size_t block_points = 16384;
constexpr std::size_t lanes = 16;

// Independent sums in fixed lanes: the compiler may use any vector width without changing a bit of the
// result.
template <typename T>
[[gnu::always_inline]] inline double sum_block(const T* theta, std::size_t count, std::size_t m) {
    const T* const middle = theta + m;
    const T* const last = theta + 2 * m;
    std::array<double, lanes> sums{};
    std::size_t k = 0;
    for (; k + lanes <= count; k += lanes) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const std::size_t i = k + lane;
            const auto d = static_cast<double>((last[i] - middle[i]) - (middle[i] - theta[i]));
            sums[lane] += d * d;
        }
    }
    for (std::size_t lane = 0; k < count; ++k, ++lane) {
        const auto d = static_cast<double>((last[k] - middle[k]) - (middle[k] - theta[k]));
        sums[lane] += d * d;
    }
    for (std::size_t width = lanes / 2; width > 0; width /= 2) {
        for (std::size_t lane = 0; lane < width; ++lane) { sums[lane] += sums[lane + width]; }
    }
    return sums[0];
}

template <typename T>
double sum_block_baseline(const T* theta, std::size_t count, std::size_t m) {
    return sum_block(theta, count, m);
}

#if defined(__x86_64__)
template <typename T>
[[gnu::target("avx2")]] double sum_block_avx2(const T* theta, std::size_t count, std::size_t m) {
    return sum_block(theta, count, m);
}
#endif

template <typename T>
double sum_block_here(const T* theta, std::size_t count, std::size_t m) {
#if defined(__x86_64__)
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    if (has_avx2) { return sum_block_avx2(theta, count, m); }
#endif
    return sum_block_baseline(theta, count, m);
}

struct Block {
    const Stretch* stretch = nullptr;
    std::size_t begin = 0;
};

void sum_all_factors(const Block& block, std::span<const std::int64_t> factors, double* sums) {
    std::visit(
        [&](const auto& theta) {
            for (std::size_t f = 0; f < factors.size(); ++f) {
                const auto m = static_cast<std::size_t>(factors[f]);
                if (block.begin + 2 * m >= theta.size()) { continue; }
                const std::size_t count = std::min(block_points, theta.size() - 2 * m - block.begin);
                sums[f] = sum_block_here(theta.data() + block.begin, count, m);
            }
        },
        block.stretch->theta.values());
}

}  // namespace

std::vector<double> sums_of_squared_differences(std::span<const Stretch> stretches,
                                                std::span<const std::int64_t> m, unsigned threads) {
    std::vector<Block> blocks;
    for (const Stretch& stretch : stretches) {
        for (std::size_t begin = stretch.begin; begin < stretch.theta.points(); begin += block_points) {
            blocks.push_back({&stretch, begin});
        }
    }
    std::vector<double> partial(blocks.size() * m.size());
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t b = next++; b < blocks.size(); b = next++) {
            sum_all_factors(blocks[b], m, partial.data() + b * m.size());
        }
    };
    {
        std::vector<std::jthread> others;
        for (unsigned i = 1; i < threads; ++i) { others.emplace_back(work); }
        work();
    }
    std::vector<double> sums(m.size());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        for (std::size_t f = 0; f < m.size(); ++f) { sums[f] += partial[b * m.size() + f]; }
    }
    return sums;
}

}  // namespace gyrolog
