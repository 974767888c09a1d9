// The whole `analyze`, from a capture's file to JSON and PNG: an hour of three axes at 1 kHz, CPU
// milliseconds of each stage. `most_MB` is the most memory that the process has had, `doubles_MB` what the
// samples of the three axes would take as double alone.

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "host/app/analysis_run.hpp"
#include "host/app/command_line.hpp"
#include "host/app/stage_clock.hpp"

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

// Of `sensor`: "gyro", or "all", the accelerometer too.
void analyze_hour_at_1kHz(benchmark::State& state, const char* sensor) {
    const Folder folder;
    std::ostringstream out;
    std::ostringstream err;
    Console console{out, err};
    AnalysisRequest request;
    request.recording_path = folder.file("hour.pcapng");
    request.sensor = sensor;
    request.json_path = folder.file("report.json");
    request.plot_path = folder.file("report.png");
    if (run_command_line(
            {"capture", "--device", "sim:rate=1000,seed=7", "--duration", "1h", "-o", request.recording_path},
            console) != ExitCode::ok) {
        state.SkipWithError(err.str().c_str());
        return;
    }
    StageClock clock;
    request.on_stage = StageObserver([&clock](const char* stage) { clock.enter(stage); });
    for (auto _ : state) {
        if (analyze_to_files(console, "analyze", request) != ExitCode::ok) {
            state.SkipWithError(err.str().c_str());
            return;
        }
        clock.stop();
    }
    for (const StageClock::Stage& stage : clock.stages()) {
        state.counters[stage.name + "_ms"] = {1e3 * stage.cpu_s, benchmark::Counter::kAvgIterations};
    }
    state.counters["most_MB"] = most_megabytes();
}

BENCHMARK_CAPTURE(analyze_hour_at_1kHz, gyro, "gyro")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(analyze_hour_at_1kHz, both, "all")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace gyrolog
