// The whole `analyze`, from a capture's file to JSON and PNG: CPU milliseconds of each stage. `most_MB` is
// the most memory that the process has had. Of a night at 100 Hz also the ratio of its CPU time to that of
// the obvious loop for the Allan deviation of the three axes, whose samples are in memory; they take turns.

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "host/app/analysis_run.hpp"
#include "host/app/command_line.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/stage_clock.hpp"
#include "tests/benchmark/cpu_time.hpp"
#include "tests/benchmark/obvious_curve.hpp"

namespace gyrolog {
namespace {

class Folder {
public:
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "gyrolog_benchmark.XXXXXX").string();
        if (mkdtemp(name.data()) != nullptr) { path_ = name; }
    }
    ~Folder() {
        std::error_code ignored;
        if (!path_.empty()) { std::filesystem::remove_all(path_, ignored); }
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string file(const char* name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

double most_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1.024e-3;
}

struct Night {
    const char* rate;  // for the virtual board
    const char* duration;
    const char* sensor;  // "gyro", or "all", the accelerometer too
    bool draws = false;  // a figure as well
    bool beside_obvious_loop = false;
};

// A loop over samples that are there already: that of the first axis, as often as there are axes.
double obvious_loop_s(const std::string& recording) {
    RecordingInput input;
    input.path = recording;
    const auto read = read_recording(input);
    if (!read.ok()) { return 0.0; }
    const std::vector<double> rate = read->find("gx")->values();
    return 3.0 * cpu_seconds_of([&] { benchmark::DoNotOptimize(obvious_curve(rate, read->rate_hz)); });
}

void analyze_night(benchmark::State& state, const Night& night) {
    const Folder folder;
    std::ostringstream out;
    std::ostringstream err;
    Console console{out, err};
    AnalysisRequest request;
    request.recording_path = folder.file("night.pcapng");
    request.sensor = night.sensor;
    request.json_path = folder.file("report.json");
    if (night.draws) { request.plot_path = folder.file("report.png"); }
    if (run_command_line({"capture", "--device", std::string("sim:seed=7,rate=") + night.rate, "--duration",
                          night.duration, "-o", request.recording_path},
                         console) != ExitCode::ok) {
        state.SkipWithError(err.str().c_str());
        return;
    }
    StageClock clock;
    request.on_stage = StageObserver([&clock](const char* stage) { clock.enter(stage); });
    double ours_s = 0.0;
    double obvious_s = 0.0;
    for (auto _ : state) {
        const double begin_s = cpu_seconds();
        if (analyze_to_files(console, "analyze", request) != ExitCode::ok) {
            state.SkipWithError(err.str().c_str());
            return;
        }
        clock.stop();
        ours_s += cpu_seconds() - begin_s;
        state.PauseTiming();
        if (night.beside_obvious_loop) { obvious_s += obvious_loop_s(request.recording_path); }
        state.ResumeTiming();
    }
    for (const StageClock::Stage& stage : clock.stages()) {
        state.counters[stage.name + "_ms"] = {1e3 * stage.cpu_s, benchmark::Counter::kAvgIterations};
    }
    state.counters["most_MB"] = most_megabytes();
    if (night.beside_obvious_loop) { state.counters["of_obvious_loop"] = ours_s / obvious_s; }
}

BENCHMARK_CAPTURE(analyze_night, 12h_at_100Hz_gyro,
                  {.rate = "100", .duration = "12h", .sensor = "gyro", .beside_obvious_loop = true})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(analyze_night, 1h_at_1kHz_gyro_figure,
                  {.rate = "1000", .duration = "1h", .sensor = "gyro", .draws = true})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(analyze_night, 1h_at_1kHz_both_figure,
                  {.rate = "1000", .duration = "1h", .sensor = "all", .draws = true})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace gyrolog
