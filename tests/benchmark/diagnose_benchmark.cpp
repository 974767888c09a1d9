// A diagnosis of a sensor at rest whose model lacks one slow noise process on x, three axes at 100 Hz, from
// the recording in memory to the answer. `s` is the wall clock's time on all processors. `x_simulating` is
// that time over the one which as many simulations of the recording alone take in the same run, on as many
// threads. `ns_n_log2_n` is the time over n log2 n of its n samples, which does not grow where the work grows
// no faster. `peak_MB` is the most memory that the process ever had.
//
// GYROLOG_SIMULATIONS: how many, 40 without it; the program itself takes 200.

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "analysis/compare/model_draw.hpp"
#include "analysis/diagnose/diagnosis.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::size_t simulations() {
    const char* given = std::getenv("GYROLOG_SIMULATIONS");
    return given != nullptr ? std::strtoul(given, nullptr, 10) : 40;
}

SensorModel calibrated() {
    SensorModel model = typical_mpu9250();
    model.rate_hz = 100.0;
    model.sd_rel = {{"N", 0.005}, {"B", 0.08}, {"K", 0.2}};
    return model;
}

SensorModel with_correlated_noise(SensorModel model) {
    EffectModel more;
    more.effect = "gauss_markov";
    more.axes = {"x"};
    more.params = {{"sigma_dps", 0.01}, {"tau_s", 20.0}};
    model.effects.push_back(more);
    return model;
}

std::shared_ptr<const Recording> recorded(double minutes) {
    SimulationRequest request;
    request.samples = static_cast<std::uint64_t>(std::lround(minutes * 60.0 * 100.0));
    request.seed = 1;
    return std::make_shared<const Recording>(
        simulate_recording(with_correlated_noise(calibrated()), request));
}

double seconds_to_simulate(const SensorModel& model, std::uint64_t samples) {
    const auto begin = Clock::now();
    parallel_for(simulations(), 0, [&](std::size_t i) {
        SimulationRequest request;
        request.samples = samples;
        request.seed = i + 1;
        benchmark::DoNotOptimize(simulate_recording(draw_within_uncertainty(model, request.seed), request));
    });
    return seconds_since(begin);
}

double peak_MB() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024e-6;
}

void diagnose_at_rest(benchmark::State& state) {
    const auto recording = recorded(static_cast<double>(state.range(0)));
    DiagnosisOptions options;
    options.simulations = simulations();
    double diagnosing_s = 0.0;
    double simulating_s = 0.0;
    for (auto _ : state) {
        const auto begin = Clock::now();
        benchmark::DoNotOptimize(diagnose(recording, calibrated(), "calibrated", options));
        diagnosing_s += seconds_since(begin);
        simulating_s += seconds_to_simulate(calibrated(), recording->rows());
    }
    const auto runs = static_cast<double>(state.iterations());
    const auto samples = static_cast<double>(recording->rows());
    state.counters["s"] = diagnosing_s / runs;
    state.counters["x_simulating"] = diagnosing_s / simulating_s;
    state.counters["ns_n_log2_n"] = 1e9 * diagnosing_s / runs / (samples * std::log2(samples));
    state.counters["peak_MB"] = peak_MB();
}

// Shorter ones first: the peak is that of all before.
BENCHMARK(diagnose_at_rest)->Arg(30)->Arg(120)->ArgName("minutes")->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace gyrolog
