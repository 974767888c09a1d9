// An array of eight gyros with three axes at 8 kHz, denoised sample by sample: what a live view would ask
// for. `of_real_time` is the CPU time of one thread, by CLOCK_PROCESS_CPUTIME_ID, over the time that the
// samples span: 1 would keep one processor busy. `x_mean` is that time over the one that taking the plain
// mean of the same samples needs in the same run. Samples are made beforehand; a millionth of them being NaN
// or a wild value does not change the picture and is left out.

#include <array>
#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>

#include "analysis/denoise/array_denoiser.hpp"
#include "analysis/simulate/counter_random.hpp"
#include "tests/benchmark/cpu_time.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 8000.0;
constexpr std::size_t units = 8;
constexpr std::size_t axes = 3;
constexpr std::size_t samples = 16'000;  // two seconds
constexpr double white_sd = 0.002;       // rad/s
constexpr double walk_sd = 1e-7;

using Sample = std::array<double, units>;

std::vector<Sample> array_at_rest() {
    std::vector<Sample> array(samples);
    std::vector<double> noise(samples);
    for (std::size_t unit = 0; unit < units; ++unit) {
        RandomStream(1, static_cast<std::uint32_t>(unit)).normals(0, noise);
        for (std::size_t k = 0; k < samples; ++k) { array[k][unit] = white_sd * noise[k]; }
    }
    return array;
}

DenoiseDesign design_of(DenoiseMethod method, FilterGain gain) {
    DenoiseDesign design;
    design.method = method;
    design.rate = default_rate_design(method, rate_hz);
    design.gain = gain;
    return design;
}

// Units unlike each other, so that no symmetry saves anything.
ArrayNoise array_noise() {
    ArrayNoise noise;
    noise.rate_hz = rate_hz;
    for (std::size_t unit = 0; unit < units; ++unit) {
        const double scale = 1.0 + 0.1 * static_cast<double>(unit);
        noise.units.push_back({scale * white_sd * white_sd, scale * walk_sd * walk_sd});
    }
    noise.white_correlation = equal_correlation(units, 0.05);
    return noise;
}

void denoise_axes(benchmark::State& state, DenoiseMethod method, FilterGain gain) {
    const std::vector<Sample> array = array_at_rest();
    UnitLimits limits;
    limits.white_sd = 1.5 * white_sd;
    double filter_s = 0.0;
    double mean_s = 0.0;
    double spanned_s = 0.0;
    const std::vector<double> no_offsets(units, 0.0);
    for (auto _ : state) {
        for (std::size_t axis = 0; axis < axes; ++axis) {
            ArrayDenoiser denoiser(array_noise(), std::vector<UnitLimits>(units, limits),
                                   design_of(method, gain), no_offsets);
            const double begin = cpu_seconds();
            for (const Sample& sample : array) { benchmark::DoNotOptimize(denoiser.step(sample)); }
            const double between = cpu_seconds();
            for (const Sample& sample : array) {
                double sum = 0.0;
                for (const double x : sample) { sum += x; }
                benchmark::DoNotOptimize(sum / units);
            }
            mean_s += cpu_seconds() - between;
            filter_s += between - begin;
        }
        spanned_s += static_cast<double>(samples) / rate_hz;
    }
    state.counters["of_real_time"] = filter_s / spanned_s;
    state.counters["x_mean"] = filter_s / mean_s;
}

BENCHMARK_CAPTURE(denoise_axes, kalman_steady, DenoiseMethod::kalman, FilterGain::steady);
BENCHMARK_CAPTURE(denoise_axes, kalman_varying, DenoiseMethod::kalman, FilterGain::varying);
BENCHMARK_CAPTURE(denoise_axes, wavelet_steady, DenoiseMethod::wavelet, FilterGain::steady);
BENCHMARK_CAPTURE(denoise_axes, joint_steady, DenoiseMethod::joint, FilterGain::steady);
BENCHMARK_CAPTURE(denoise_axes, joint_varying, DenoiseMethod::joint, FilterGain::varying);

}  // namespace
}  // namespace gyrolog
