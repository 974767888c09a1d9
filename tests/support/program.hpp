// Runs the built program as a user does: arguments in; exit code, standard output and standard error out.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace gyrolog {

struct ProgramResult {
    int exit_code = -1;  // 128 + the signal's number for a program that a signal ended
    std::string out;
    std::string err;
};

// The program under test: build/gyrolog by GYROLOG_BUILD_DIR.
ProgramResult run_gyrolog(const std::vector<std::string>& arguments);
// The same, but `signal` is sent after a while: from the start, or from when the file `once_there` exists.
ProgramResult run_gyrolog_and_signal(const std::vector<std::string>& arguments,
                                     std::chrono::milliseconds after, int signal,
                                     const std::string& once_there = "");

std::string read_whole_file(const std::filesystem::path& path);

// A folder of its own for a test, gone with it.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

private:
    std::filesystem::path folder_;
};

}  // namespace gyrolog
