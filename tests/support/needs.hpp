// What a test needs that not every machine has, and the sentence that it skips with there:
// tools/skipped_tests counts the skipped tests by these sentences.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace gyrolog {

// The recordings and curves of others lie beside the project, in ../shared/data. Where that folder is there,
// all of them are: a file that is missing from it fails its test.
inline constexpr const char* needs_shared_data = "needs the recordings of others in ../shared/data";

inline std::string shared_data(const std::string& name) {
    const char* source = std::getenv("GYROLOG_SOURCE_DIR");
    return std::string(source == nullptr ? "." : source) + "/../shared/data/" + name;
}

inline bool has_shared_data() { return std::filesystem::is_directory(shared_data("")); }

inline constexpr const char* needs_full_disk = "needs /dev/full";

inline bool has_full_disk() { return std::filesystem::exists("/dev/full"); }

inline constexpr const char* needs_umockdev_wrapper = "needs umockdev-wrapper around it";

inline std::string needs_program(const std::string& name) { return "needs " + name; }

inline bool has_program(const std::string& name) {
    const std::string command = "command -v " + name + " >/dev/null 2>&1";
    return std::system(command.c_str()) == 0;  // NOLINT(cert-env33-c): a test's own fixed name
}

}  // namespace gyrolog
