#include "host/app/output_paths.hpp"

#include <filesystem>

#include <fmt/format.h>

namespace gyrolog {
namespace {

bool same_file(const std::string& a, const std::string& b) {
    if (a.empty() || b.empty() || a == "-" || b == "-") { return false; }
    std::error_code none;
    // A terminal or /dev/null takes what it gets, and keeps nothing.
    const auto there = std::filesystem::status(a, none);
    if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) { return false; }
    if (a == b) { return true; }
    if (std::filesystem::equivalent(a, b, none)) { return true; }
    // Not there yet: two ways to write one name.
    const auto place_a = std::filesystem::weakly_canonical(std::filesystem::absolute(a, none), none);
    const auto place_b = std::filesystem::weakly_canonical(std::filesystem::absolute(b, none), none);
    return !place_a.empty() && place_a == place_b;
}

Error same(const NamedPath& a, const NamedPath& b, const char* advice) {
    return {ErrorCode::invalid_argument,
            fmt::format("{} and {} are the same file '{}'{}", a.option, b.option, b.path, advice)};
}

}  // namespace

Status check_output_paths(std::span<const NamedPath> read, std::span<const NamedPath> written) {
    for (std::size_t i = 0; i < written.size(); ++i) {
        for (const NamedPath& source : read) {
            if (same_file(source.path, written[i].path)) {
                return same(source, written[i], "; give another to write");
            }
        }
        for (std::size_t other = i + 1; other < written.size(); ++other) {
            if (same_file(written[i].path, written[other].path)) {
                return same(written[i], written[other], "");
            }
        }
    }
    return {};
}

}  // namespace gyrolog
