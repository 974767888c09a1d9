// Runs the built program as a user does: arguments in; exit code, standard output and standard error out.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace gyrolog {

struct ProgramResult {
    int exit_code = -1;  // 128 + the signal's number for a program that a signal ended
    std::string out;
    std::string err;
    std::int64_t signalled_ns = 0;  // monotonic, just before a signal was sent; 0: none was
};

// The program under test: in GYROLOG_BUILD_DIR, or beside the one that asks.
std::string gyrolog_path();

// Starts a command without input. Its output goes to these descriptors, with -1 nowhere.
pid_t start_program(const std::vector<std::string>& command, int out, int err);

ProgramResult run_gyrolog(const std::vector<std::string>& arguments);
// Under its own name, or under that which it has until it is whole.
enum class FileState { is_there, holds_something };

// The same, but `signal` is sent after a while: from the start, or from when the file `once_there` is in this
// state.
ProgramResult run_gyrolog_and_signal(const std::vector<std::string>& arguments,
                                     std::chrono::milliseconds after, int signal,
                                     const std::string& once_there = "",
                                     FileState state = FileState::is_there);

// The same, but the program is stopped after a while and goes on when it was held for so long.
ProgramResult run_gyrolog_and_hold(const std::vector<std::string>& arguments, std::chrono::milliseconds after,
                                   std::chrono::milliseconds held);

std::string read_whole_file(const std::filesystem::path& path);

// A folder of its own for a test, gone with it. The documents in it must keep their schemas
// (schema_check.hpp), unless the test says that it writes some that do not.
class TemporaryFolder {
public:
    enum class Documents { keep_schemas, are_wrong_on_purpose };
    explicit TemporaryFolder(Documents documents = Documents::keep_schemas);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

private:
    std::filesystem::path folder_;
    Documents documents_;
};

}  // namespace gyrolog
