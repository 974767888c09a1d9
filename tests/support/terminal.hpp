// The program under test on a terminal of its own, as a user has it.
#pragma once

#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "tests/support/program.hpp"

namespace gyrolog {

class Terminal {
public:
    enum class Place { foreground, background };

    explicit Terminal(std::vector<std::string> arguments, Place place = Place::foreground) {
        const winsize size{30, 100, 0, 0};
        arguments.insert(arguments.begin(), gyrolog_path());
        if (place == Place::background) {
            arguments.insert(arguments.begin(), {"/bin/sh", "-c", "set -m; \"$@\" & wait $!", "sh"});
        }
        std::vector<char*> argv;
        argv.reserve(arguments.size() + 1);
        for (std::string& argument : arguments) { argv.push_back(argument.data()); }
        argv.push_back(nullptr);
        child_ = forkpty(&line_, nullptr, nullptr, &size);
        if (child_ == 0) {
            execv(argv[0], argv.data());
            _exit(127);
        }
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;
    ~Terminal() {
        if (child_ > 0) {
            kill(child_, SIGKILL);
            waitpid(child_, nullptr, 0);
        }
        close(line_);
    }

    void type(const std::string& keys) {
        EXPECT_EQ(write(line_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
    }
    // Whether this came on the screen since the last call, within ten seconds.
    bool shows(const std::string& text) {
        using Clock = std::chrono::steady_clock;
        const auto start = Clock::now();
        while (Clock::now() - start < std::chrono::seconds(10)) {
            const std::size_t found = screen_.find(text, seen_);
            if (found != std::string::npos) {
                seen_ = found + text.size();
                return true;
            }
            if (!read_more()) { break; }
        }
        return screen_.find(text, seen_) != std::string::npos;
    }
    bool echoes() const {
        termios mode{};
        EXPECT_EQ(tcgetattr(line_, &mode), 0);
        return (mode.c_lflag & static_cast<tcflag_t>(ECHO)) != 0;
    }
    void set_echo(bool echo) {
        termios mode{};
        EXPECT_EQ(tcgetattr(line_, &mode), 0);
        const auto line = static_cast<tcflag_t>(ECHO | ICANON);
        mode.c_lflag = echo ? mode.c_lflag | line : mode.c_lflag & ~line;
        EXPECT_EQ(tcsetattr(line_, TCSANOW, &mode), 0);
    }
    void send(int signal) const { EXPECT_EQ(kill(child_, signal), 0); }
    // As run_gyrolog's.
    int wait() {
        while (read_more()) {}
        int status = 0;
        waitpid(child_, &status, 0);
        child_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    const std::string& screen() const { return screen_; }

private:
    bool read_more() {
        pollfd input{line_, POLLIN, 0};
        if (poll(&input, 1, 10'000) <= 0) { return false; }
        std::array<char, 4096> bytes{};
        const ssize_t count = read(line_, bytes.data(), bytes.size());
        if (count <= 0) { return false; }
        screen_.append(bytes.data(), static_cast<std::size_t>(count));
        return true;
    }

    pid_t child_ = -1;
    int line_ = -1;
    std::string screen_;
    std::size_t seen_ = 0;
};

}  // namespace gyrolog
