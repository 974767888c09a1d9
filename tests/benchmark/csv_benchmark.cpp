// Reading a recording from text: an hour of three axes and a temperature at 100 Hz, in bytes of text per
// second.

#include <random>
#include <string>

#include <benchmark/benchmark.h>

#include "host/formats/recording_csv.hpp"

namespace gyrolog {
namespace {

std::string an_hour() {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(-0.3, 0.14);
    std::string text = "t_s,gx_dps,gy_dps,gz_dps,temp_C\n";
    for (int i = 0; i < 360000; ++i) {
        text += std::to_string(i * 0.01);
        for (int axis = 0; axis < 3; ++axis) {
            text += ',';
            text += std::to_string(normal(random));
        }
        text += ",25.19\n";
    }
    return text;
}

void parse_csv(benchmark::State& state) {
    const std::string text = an_hour();
    for (auto _ : state) { benchmark::DoNotOptimize(parse_recording_csv(text, "hour.csv").ok()); }
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}

BENCHMARK(parse_csv)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gyrolog
