// The overlapping Allan deviation, intervals and all, beside the loop that anyone would write first: double
// precision, its theta built once, compiled with -Ofast. Both begin with the samples in memory and
// take turns on one thread, so that whatever else the machine does slows both; `x_faster` is the ratio of
// their CPU times, and the time shown is that of allan_deviation().

#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>

#include <benchmark/benchmark.h>

#include "analysis/allan/allan_deviation.hpp"
#include "analysis/allan/difference_sums.hpp"
#include "tests/benchmark/cpu_time.hpp"
#include "tests/benchmark/obvious_curve.hpp"

namespace gyrolog {
namespace {

struct Record {
    std::size_t samples = 0;
    int axes = 1;
    double rate_hz = 100.0;
};

constexpr Record night_at_100_Hz{std::size_t{12} * 3600 * 100, 3, 100.0};
constexpr Record six_hours_at_1_kHz{std::size_t{6} * 3600 * 1000, 1, 1000.0};
constexpr Record hour_at_100_Hz{std::size_t{3600} * 100, 1, 100.0};

Column counts_of(const Record& record) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(-20.0, 9.0);
    std::vector<std::int16_t> counts(record.samples);
    for (auto& x : counts) { x = static_cast<std::int16_t>(std::lround(normal(random))); }
    return {"gx", "rad/s", std::move(counts), 1.0, 0.0, "lsb"};
}

Column reals_of(const Record& record) {
    Column column = counts_of(record);
    column.data = column.values();
    return column;
}

void deviation_beside_obvious_loop(benchmark::State& state, const Record& record, const Column& column) {
    const std::vector<double> rate = column.values();
    const std::vector<Segment> whole = {{0, record.samples, 0}};
    double obvious_s = 0.0;
    double ours_s = 0.0;
    for (auto _ : state) {
        const double before_s = ours_s;
        for (int axis = 0; axis < record.axes; ++axis) {
            obvious_s +=
                cpu_seconds_of([&] { benchmark::DoNotOptimize(obvious_curve(rate, record.rate_hz)); });
            ours_s += cpu_seconds_of(
                [&] { benchmark::DoNotOptimize(allan_deviation(column, whole, record.rate_hz)); });
        }
        state.SetIterationTime(ours_s - before_s);
    }
    state.counters["x_faster"] = obvious_s / ours_s;
}

void deviation_of_counts(benchmark::State& state, const Record& record) {
    deviation_beside_obvious_loop(state, record, counts_of(record));
}

void deviation_of_reals(benchmark::State& state, const Record& record) {
    deviation_beside_obvious_loop(state, record, reals_of(record));
}

BENCHMARK_CAPTURE(deviation_of_counts, 12h_3_axes_100Hz, night_at_100_Hz)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK_CAPTURE(deviation_of_counts, 6h_1_axis_1kHz, six_hours_at_1_kHz)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK_CAPTURE(deviation_of_reals, 12h_3_axes_100Hz, night_at_100_Hz)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK_CAPTURE(deviation_of_reals, 6h_1_axis_1kHz, six_hours_at_1_kHz)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();

// How much two threads help: wall clock.
void deviation_on_threads(benchmark::State& state) {
    const Column column = counts_of(night_at_100_Hz);
    const std::vector<Segment> whole = {{0, night_at_100_Hz.samples, 0}};
    AllanOptions options;
    options.threads = static_cast<unsigned>(state.range(0));
    for (auto _ : state) { benchmark::DoNotOptimize(allan_deviation(column, whole, 100.0, options)); }
}

BENCHMARK(deviation_on_threads)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

// Every m from 1 to half the samples of an hour: 3.2e10 differences.
void every_averaging_factor(benchmark::State& state) {
    const Column column = counts_of(hour_at_100_Hz);
    std::vector<std::int64_t> m(hour_at_100_Hz.samples / 2);
    std::iota(m.begin(), m.end(), 1);
    std::vector<Stretch> stretches;
    stretches.push_back({PrefixSum(column, raw_mean(column), 0, column.size()), 0});
    for (auto _ : state) { benchmark::DoNotOptimize(sums_of_squared_differences(stretches, m, 1)); }
}

BENCHMARK(every_averaging_factor)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace gyrolog
