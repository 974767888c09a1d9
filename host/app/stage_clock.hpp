// Where a command spends its time.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>

namespace gyrolog {

class StageClock {
public:
    struct Stage {
        std::string name;
        double wall_s = 0.0;
        double cpu_s = 0.0;  // of all threads
    };

    // From now on time counts for this stage, in addition to what it has from before.
    void enter(std::string_view name) {
        stop();
        const auto known = std::ranges::find(stages_, name, &Stage::name);
        running_ = static_cast<std::size_t>(known - stages_.begin());
        if (known == stages_.end()) { stages_.push_back({std::string(name)}); }
    }
    void stop() {
        const auto wall = std::chrono::steady_clock::now();
        const double cpu_s = process_cpu_s();
        if (running_ < stages_.size()) {
            stages_[running_].wall_s += std::chrono::duration<double>(wall - wall_).count();
            stages_[running_].cpu_s += cpu_s - cpu_s_;
        }
        wall_ = wall;
        cpu_s_ = cpu_s;
        running_ = stages_.size();
    }
    const std::vector<Stage>& stages() const { return stages_; }

private:
    static double process_cpu_s() {
        std::timespec now{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }

    std::vector<Stage> stages_;  // in the order in which they were first entered
    std::size_t running_ = 0;    // stages_.size(): none
    std::chrono::steady_clock::time_point wall_;
    double cpu_s_ = 0.0;
};

// A line a stage, and one for the sum with the most memory that the process has had.
inline void write_timing(std::ostream& out, const StageClock& clock) {
    StageClock::Stage sum{"together"};
    out << fmt::format("{:<12} {:>8} {:>8}\n", "stage", "wall s", "CPU s");
    const auto line = [](const StageClock::Stage& stage) {
        return fmt::format("{:<12} {:>8.3f} {:>8.3f}", stage.name, stage.wall_s, stage.cpu_s);
    };
    for (const StageClock::Stage& stage : clock.stages()) {
        out << line(stage) << '\n';
        sum.wall_s += stage.wall_s;
        sum.cpu_s += stage.cpu_s;
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    out << line(sum)
        << fmt::format("   most memory {:.0f} MB\n", static_cast<double>(usage.ru_maxrss) * 1.024e-3);
}

}  // namespace gyrolog
