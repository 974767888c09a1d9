// The simulated sensor's noise: white noise, flicker noise and random walk on three axes, rounded to counts.
// Each block of samples is dropped where it was made. `hours_per_s` are hours of three axes at 1 kHz in a
// second of one thread's CPU time, `x_faster` is the ratio of CPU times of two ways that take turns, so that
// whatever else the machine does slows both.

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "analysis/simulate/converter.hpp"
#include "analysis/simulate/flicker_noise.hpp"
#include "analysis/simulate/sensor_simulator.hpp"
#include "analysis/simulate/stepped_sensor.hpp"
#include "tests/benchmark/cpu_time.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 1000.0;
constexpr std::size_t ten_minutes = 600'000;  // samples an axis

double hours(double samples_an_axis) { return samples_an_axis / rate_hz / 3600.0; }

SensorModel noise_alone() {
    SensorModel model = typical_mpu9250();
    model.timestamp_jitter_s = 0.0;
    model.temp_noise_C = 0.0;
    return model;
}

void simulate_ten_minutes() {
    SensorSimulator simulator(noise_alone(), rate_hz, 1);
    for (std::size_t done = 0; done < ten_minutes; done += block_samples) {
        benchmark::DoNotOptimize(simulator.next_block().counts.data());
        benchmark::ClobberMemory();
    }
}

// One noise after the other, then all that a typical sensor has, the jitter of its clock and its thermometer
// included.
SensorModel only_white() {
    SensorModel model = noise_alone();
    for (AxisModel& axis : model.axes) { axis.noise = {.N_rad_per_sqrt_s = axis.noise.N_rad_per_sqrt_s}; }
    return model;
}
SensorModel only_flicker() {
    SensorModel model = noise_alone();
    for (AxisModel& axis : model.axes) { axis.noise = {.B_rad_per_s = axis.noise.B_rad_per_s}; }
    return model;
}
SensorModel only_walk() {
    SensorModel model = noise_alone();
    for (AxisModel& axis : model.axes) { axis.noise = {.K_rad_per_s_sqrt_s = axis.noise.K_rad_per_s_sqrt_s}; }
    return model;
}
SensorModel silent() {
    SensorModel model = noise_alone();
    for (AxisModel& axis : model.axes) { axis.noise = {}; }
    return model;
}

void simulate(benchmark::State& state, const SensorModel& model) {
    SensorSimulator simulator(model, rate_hz, 1);
    for (auto _ : state) {
        benchmark::DoNotOptimize(simulator.next_block().counts.data());
        benchmark::ClobberMemory();
    }
    const auto samples = static_cast<double>(state.iterations()) * static_cast<double>(block_samples);
    state.counters["axis_samples"] = {3.0 * samples, benchmark::Counter::kIsRate};
    state.counters["hours_per_s"] = {hours(samples), benchmark::Counter::kIsRate};
}

BENCHMARK_CAPTURE(simulate, no_noise, silent());
BENCHMARK_CAPTURE(simulate, white_noise, only_white());
BENCHMARK_CAPTURE(simulate, flicker_noise, only_flicker());
BENCHMARK_CAPTURE(simulate, random_walk, only_walk());
BENCHMARK_CAPTURE(simulate, all_three, noise_alone());
BENCHMARK_CAPTURE(simulate, typical_sensor, typical_mpu9250());

// In another simulator's loop, a step and a sample each millisecond.
void step(benchmark::State& state, const SensorModel& model) {
    SteppedSensor sensor(model, rate_hz, 1);
    WorldInstant now;
    SteppedSample sample;
    std::uint64_t steps = 0;
    for (auto _ : state) {
        now.t_s = static_cast<double>(steps++) / rate_hz;
        if (sensor.step(now) != SteppedSensor::Step::taken) { state.SkipWithError("no step"); }
        while (sensor.take(sample) == SteppedSensor::Take::sample) { benchmark::DoNotOptimize(sample); }
    }
}

BENCHMARK_CAPTURE(step, no_noise, silent());
BENCHMARK_CAPTURE(step, typical_sensor, typical_mpu9250());

// Flicker noise as an autoregressive filter, N. J. Kasdin, Proc. IEEE 83 (1995) 802-827, eq. 116: a_0 = 1,
// a_k = a_(k-1) (k - 1 - alpha/2) / k, alpha = 1, cut off after `poles`. MATLAB's fractalcoef makes these
// coefficients for the BiasInstabilityCoefficients of its gyroparams.
std::vector<double> fractional_poles(std::size_t poles) {
    std::vector<double> a = {1.0};
    for (std::size_t k = 1; k <= poles; ++k) {
        a.push_back(a.back() * (static_cast<double>(k) - 1.5) / static_cast<double>(k));
    }
    return a;
}
constexpr std::size_t many_poles = 500;

class ObviousAxis {
public:
    ObviousAxis(const NoiseCoefficients& noise, unsigned seed) : noise_(noise), random_(seed) {}

    void simulate(std::size_t samples, const Converter& converter) {
        const std::vector<double> a = fractional_poles(many_poles);
        std::vector<double> flicker(samples);
        std::vector<std::int16_t> counts(samples);
        double walk = 0.0;
        for (std::size_t n = 0; n < samples; ++n) {
            flicker[n] = normal_(random_);
            for (std::size_t k = 1; k <= std::min(n, many_poles); ++k) {
                flicker[n] -= a[k] * flicker[n - k];
            }
            const double white = normal_(random_) * noise_.N_rad_per_sqrt_s * std::sqrt(rate_hz);
            counts[n] = converter(white + noise_.B_rad_per_s * flicker[n] + walk);
            walk += normal_(random_) * noise_.K_rad_per_s_sqrt_s / std::sqrt(rate_hz);
        }
        benchmark::DoNotOptimize(counts.data());
    }

private:
    NoiseCoefficients noise_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
};

void report_beside(benchmark::State& state, double ours_s, double other_s, const char* other) {
    const double done_hours = hours(static_cast<double>(state.iterations() * std::int64_t{ten_minutes}));
    state.counters["hours_per_s"] = done_hours / ours_s;
    state.counters[std::string("hours_per_s_") + other] = done_hours / other_s;
    state.counters["x_faster"] = other_s / ours_s;
}

void beside_500_poles(benchmark::State& state) {
    const SensorModel model = noise_alone();
    const Converter converter(model.lsb_rad_s, model.saturation_rad_s);
    double poles_s = 0.0;
    double ours_s = 0.0;
    for (auto _ : state) {
        const double before_s = ours_s;
        ours_s += cpu_seconds_of([] { simulate_ten_minutes(); });
        for (unsigned axis = 0; axis < 3; ++axis) {
            poles_s += cpu_seconds_of(
                [&] { ObviousAxis(model.axes[axis].noise, axis).simulate(ten_minutes, converter); });
        }
        state.SetIterationTime(ours_s - before_s);
    }
    report_beside(state, ours_s, poles_s, "500_poles");
}

BENCHMARK(beside_500_poles)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(1);

// Flicker noise from a white spectrum by an inverse FFT over the whole record. Prints the CPU seconds of the
// fastest of three; the first may still load libraries.
constexpr const char* numpy_script = R"(
import sys, time
import numpy as np
def axis(random, n, white, flicker, walk, lsb):
    nu = np.fft.rfftfreq(n)
    spectrum = random.standard_normal(nu.size) + 1j * random.standard_normal(nu.size)
    spectrum[0] = 0
    spectrum[1:] *= flicker * np.sqrt(n / (4 * np.pi * nu[1:]))
    x = np.fft.irfft(spectrum, n)
    x += white * random.standard_normal(n)
    x += np.cumsum(walk * random.standard_normal(n))
    return np.clip(np.rint(x / lsb), -32768, 32767).astype(np.int16)
n, *noise = [float(word) for word in sys.argv[1:]]
fastest = float("inf")
for seed in range(3):
    random = np.random.default_rng(seed)
    begin = time.process_time()
    for _ in range(3):
        axis(random, int(n), *noise)
    fastest = min(fastest, time.process_time() - begin)
print(fastest)
)";

// Empty where no Python with numpy is.
std::optional<double> numpy_seconds(const SensorModel& model) {
    const NoiseCoefficients& noise = model.axes[0].noise;
    std::string arguments = " -c '" + std::string(numpy_script) + "' " + std::to_string(ten_minutes);
    for (const double argument : {noise.N_rad_per_sqrt_s * std::sqrt(rate_hz), noise.B_rad_per_s,
                                  noise.K_rad_per_s_sqrt_s / std::sqrt(rate_hz), model.lsb_rad_s}) {
        char text[32];
        std::snprintf(text, sizeof text, " %.17g", argument);
        arguments += text;
    }
    for (const char* python : {"python3", "/usr/bin/python3"}) {
        const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(
            popen((python + arguments + " 2>/dev/null").c_str(), "r"), pclose);
        double seconds = 0.0;
        if (pipe && std::fscanf(pipe.get(), "%lf", &seconds) == 1) { return seconds; }
    }
    return std::nullopt;
}

void beside_numpy(benchmark::State& state) {
    double numpy_s = 0.0;
    double ours_s = 0.0;
    for (auto _ : state) {
        const auto seconds = numpy_seconds(noise_alone());
        if (!seconds) {
            state.SkipWithError("no Python with numpy");
            return;
        }
        const double before_s = ours_s;
        ours_s += cpu_seconds_of([] { simulate_ten_minutes(); });
        numpy_s += *seconds;
        state.SetIterationTime(ours_s - before_s);
    }
    report_beside(state, ours_s, numpy_s, "numpy");
}

BENCHMARK(beside_numpy)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(3);

// How much density the flicker noise lacks at a frequency, in dB below 1/f, exactly.
double density_of_poles(const std::vector<double>& a, double nu) {
    std::complex<double> sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        sum += a[k] * std::polar(1.0, -2.0 * pi * nu * static_cast<double>(k));
    }
    return 1.0 / std::norm(sum);
}

void flicker_density_dB(benchmark::State& state) {
    const std::vector<double> one = fractional_poles(1);
    const std::vector<double> many = fractional_poles(many_poles);
    for (auto _ : state) {
        for (int decade = 1; decade <= 6; ++decade) {
            const double nu = std::pow(10.0, -decade);
            const auto dB = [&](double density) { return 10.0 * std::log10(density * 2.0 * pi * nu); };
            const std::string at = "_at_1e-" + std::to_string(decade);
            state.counters["1_pole" + at] = dB(density_of_poles(one, nu));
            state.counters["500_poles" + at] = dB(density_of_poles(many, nu));
            state.counters["ours" + at] = dB(FlickerNoise::expected_psd(nu, FlickerNoise::default_processes));
        }
    }
}

BENCHMARK(flicker_density_dB)->Iterations(1);

}  // namespace
}  // namespace gyrolog
