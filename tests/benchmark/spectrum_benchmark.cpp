// The spectrum and the lines of twelve hours of counts at 1 kHz, one axis, one thread; and the memory that
// the periodograms take beside the samples is that of their pieces, whatever the length.

#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <random>
#include <unsupported/Eigen/FFT>
#include <vector>

#include <benchmark/benchmark.h>

#include "analysis/spectrum/power_spectrum.hpp"
#include "analysis/spectrum/spectral_lines.hpp"
#include "tests/benchmark/cpu_time.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 1000.0;
constexpr std::size_t samples = std::size_t{12} * 3600 * 1000;

const Column& counts() {
    static const Column column = [] {
        std::mt19937_64 random(1);
        std::normal_distribution<double> normal(300.0, 20.0);
        std::vector<std::int16_t> values(samples);
        for (std::size_t i = 0; i < samples; ++i) {
            const double line = std::sin(2.0 * std::numbers::pi * 0.05003 * static_cast<double>(i));
            values[i] = static_cast<std::int16_t>(std::lround(normal(random) + line));
        }
        return Column{"gx", "lsb", std::move(values)};
    }();
    return column;
}

const std::vector<Segment> whole{{0, samples, 0}};

void spectrum(benchmark::State& state) {
    const Column& column = counts();
    for (auto _ : state) {
        benchmark::DoNotOptimize(power_spectrum(averaged_periodograms(column, whole, rate_hz)));
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples));
}

void lines_in_the_spectrum(benchmark::State& state) {
    const Column& column = counts();
    const auto periodograms = averaged_periodograms(column, whole, rate_hz);
    for (auto _ : state) { benchmark::DoNotOptimize(find_lines(periodograms, column, whole, rate_hz)); }
}

// CPU time of a transform as the pieces have it, by its length: the periodograms' longest, and the power of
// two below it. They take turns; `of_power_of_two` is the ratio of their times a sample.
void transform_of_a_piece(benchmark::State& state) {
    Eigen::FFT<double> transform;
    transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    std::vector<std::complex<double>> spectrum;
    const auto seconds_per_sample = [&](std::size_t length) {
        const std::vector<double> piece(length, 1.0);
        return cpu_seconds_of([&] { transform.fwd(spectrum, piece); }) / static_cast<double>(length);
    };
    double ours_s = 0.0;
    double power_of_two_s = 0.0;
    for (auto _ : state) {
        ours_s += seconds_per_sample(longest_piece);
        power_of_two_s += seconds_per_sample(std::bit_floor(longest_piece));
    }
    state.counters["of_power_of_two"] = ours_s / power_of_two_s;
}

BENCHMARK(transform_of_a_piece)->Iterations(100);
BENCHMARK(spectrum)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(lines_in_the_spectrum)->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace
}  // namespace gyrolog
