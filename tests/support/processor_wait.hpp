// How long a thread that has something to do waits for a processor on this machine, now: beside a test whose
// bounds must not depend on what else runs.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

namespace gyrolog {

// Measures for as long as it lives, by a thread that sleeps and sees by how much it wakes up too late.
class ProcessorWait {
public:
    ProcessorWait() : thread_([this] { run(); }) {}
    ProcessorWait(const ProcessorWait&) = delete;
    ProcessorWait& operator=(const ProcessorWait&) = delete;
    ~ProcessorWait() {
        stop_ = true;
        thread_.join();
    }

    // So far.
    double longest_s() const { return longest_s_; }

private:
    void run() {
        using Clock = std::chrono::steady_clock;
        constexpr std::chrono::milliseconds asleep(2);
        while (!stop_) {
            const auto begin = Clock::now();
            std::this_thread::sleep_for(asleep);
            const double late_s = std::chrono::duration<double>(Clock::now() - begin - asleep).count();
            longest_s_ = std::max(longest_s_.load(), late_s);
        }
    }

    std::atomic<bool> stop_ = false;
    std::atomic<double> longest_s_ = 0.0;
    std::thread thread_;
};

}  // namespace gyrolog
