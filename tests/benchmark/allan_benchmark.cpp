// The overlapping Allan deviation of a night: 12 h, three axes, 100 Hz, 93 averaging times. The yardstick is
// the loop that anyone would write first, in double precision, compiled with the same flags.

#include <cmath>
#include <cstdint>
#include <random>

#include <benchmark/benchmark.h>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/allan/averaging_factors.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t samples = 12 * 3600 * 100;
constexpr int axes = 3;

const std::vector<std::int16_t>& night() {
    static const std::vector<std::int16_t> counts = [] {
        std::mt19937_64 random(1);
        std::normal_distribution<double> normal(-20.0, 9.0);
        std::vector<std::int16_t> values(samples);
        for (auto& value : values) { value = static_cast<std::int16_t>(std::lround(normal(random))); }
        return values;
    }();
    return counts;
}

double obvious_deviation(const std::vector<double>& theta, std::size_t m, double tau_s) {
    double sum = 0.0;
    const std::size_t terms = theta.size() - 2 * m;
    for (std::size_t k = 0; k < terms; ++k) {
        const double d = theta[k + 2 * m] - 2.0 * theta[k + m] + theta[k];
        sum += d * d;
    }
    return std::sqrt(sum / (2.0 * tau_s * tau_s * static_cast<double>(terms)));
}

void obvious_double_loop(benchmark::State& state) {
    const std::vector<double> rate(night().begin(), night().end());
    const auto factors = averaging_factors(static_cast<std::int64_t>(samples));
    for (auto _ : state) {
        for (int axis = 0; axis < axes; ++axis) {
            std::vector<double> theta(samples + 1);
            for (std::size_t i = 0; i < samples; ++i) { theta[i + 1] = theta[i] + (rate[i] + 20.0) * 0.01; }
            for (const std::int64_t m : factors) {
                benchmark::DoNotOptimize(
                    obvious_deviation(theta, static_cast<std::size_t>(m), static_cast<double>(m) * 0.01));
            }
        }
    }
}

void analyze_night(benchmark::State& state, const Column& column) {
    const std::vector<Segment> whole = {{0, samples, 0}};
    AllanOptions options;
    options.threads = static_cast<unsigned>(state.range(0));
    for (auto _ : state) {
        for (int axis = 0; axis < axes; ++axis) {
            benchmark::DoNotOptimize(allan_deviation(column, whole, 100.0, options));
        }
    }
}

void counts_with_intervals(benchmark::State& state) {
    analyze_night(state, {"gx", "rad/s", night(), 1.0, 0.0, "lsb"});
}

void reals_with_intervals(benchmark::State& state) {
    analyze_night(state,
                  {"gx", "rad/s", std::vector<double>(night().begin(), night().end()), 1.0, 0.0, "rad_s"});
}

BENCHMARK(obvious_double_loop)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(counts_with_intervals)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(reals_with_intervals)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace gyrolog
