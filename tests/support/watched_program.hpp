// The program under test as a process of its own, whose memory and processor time are watched while it runs.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/program.hpp"

namespace gyrolog {

struct WatchedRun {
    int exit_code = -1;
    double elapsed_s = 0.0;
    double processor_s = 0.0;
    std::vector<std::size_t> resident_kB;  // every quarter of a second
    std::size_t peak_kB = 0;

    // Mean over a part of the run, 0 to 1.
    double mean_kB(double from, double to) const {
        const auto at = [&](double part) {
            return static_cast<std::size_t>(part * static_cast<double>(resident_kB.size()));
        };
        double sum = 0.0;
        for (std::size_t i = at(from); i < at(to); ++i) { sum += static_cast<double>(resident_kB[i]); }
        return at(to) > at(from) ? sum / static_cast<double>(at(to) - at(from)) : 0.0;
    }
};

// A number in kB of /proc/PID/status; 0 when it is not there.
inline std::size_t status_kB(pid_t process, const std::string& name) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with(name + ":")) { return std::stoul(line.substr(name.size() + 1)); }
    }
    return 0;
}

// Standard error goes to the file, standard output nowhere.
inline WatchedRun run_watched(const std::vector<std::string>& command, const std::string& err_path) {
    const auto start = std::chrono::steady_clock::now();
    const int err = open(err_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    const pid_t child = start_program(command, -1, err);
    close(err);
    WatchedRun run;
    int status = 0;
    rusage used{};
    while (wait4(child, &status, WNOHANG, &used) == 0) {
        if (const std::size_t resident_kB = status_kB(child, "VmRSS"); resident_kB > 0) {
            run.resident_kB.push_back(resident_kB);
        }
        run.peak_kB = std::max(run.peak_kB, status_kB(child, "VmHWM"));
        std::this_thread::sleep_for(std::chrono::milliseconds(250));
    }
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    run.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    run.processor_s = seconds(used.ru_utime) + seconds(used.ru_stime);
    return run;
}

}  // namespace gyrolog
