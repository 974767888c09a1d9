#include "host/app/output_paths.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "host/base/replacing_file.hpp"
#include "host/capture/segment_files.hpp"
#include "host/formats/model_source.hpp"

namespace gyrolog {
namespace {

// A terminal, a pipe or /dev/null takes what it gets, and keeps nothing.
bool takes_anything(const std::string& path) {
    if (own_descriptor(path)) { return true; }
    std::error_code none;
    const auto there = std::filesystem::status(path, none);
    return std::filesystem::exists(there) && !std::filesystem::is_regular_file(there) &&
           !std::filesystem::is_directory(there);
}

Error same(const NamedPath& a, const NamedPath& b, const char* advice) {
    return {ErrorCode::invalid_argument,
            fmt::format("{} and {} are the same file '{}'{}", a.option, b.option, b.path, advice)};
}

Status check_stream(const NamedPath& written) {
    if (written.path != "-" || std::string_view(written.option).starts_with("--json")) { return {}; }
    return invalid_argument(std::string(written.option) +
                            " '-': only --json goes to standard output; give the name of a file");
}

// By what will be done: rules about directories and rights are the system's.
Status try_to_write(const std::string& path) {
    if (path.empty() || path == "-" || takes_anything(path)) { return {}; }
    const auto file = ReplacingFile::create(path);
    return file.ok() ? Status() : Status(in_context("write '" + path + "'", file.error()));
}

// What is read where this is given: the model without the name of its sensor, a capture with the files that
// go on with it.
std::vector<std::string> files_of(const std::string& source) {
    std::vector<std::string> files{model_path(source).file};
    if (source.empty() || takes_anything(source)) { return files; }
    for (std::string& file : segment_files(source)) { files.push_back(std::move(file)); }
    return files;
}

}  // namespace

bool same_file(const std::string& a, const std::string& b) {
    if (a.empty() || b.empty() || a == "-" || b == "-") { return false; }
    if (takes_anything(a)) { return false; }
    if (a == b) { return true; }
    std::error_code none;
    if (std::filesystem::equivalent(a, b, none)) { return true; }
    // Not there yet: two ways to write one name.
    const auto place_a = std::filesystem::weakly_canonical(std::filesystem::absolute(a, none), none);
    const auto place_b = std::filesystem::weakly_canonical(std::filesystem::absolute(b, none), none);
    return !place_a.empty() && place_a == place_b;
}

Status check_output_paths(std::span<const NamedPath> read, std::span<const NamedPath> written) {
    for (const NamedPath& source : read) {
        if (source.path == "-") {
            return invalid_argument(std::string(source.option) +
                                    " '-': standard input is read by its name, /dev/stdin");
        }
    }
    for (std::size_t i = 0; i < written.size(); ++i) {
        GYROLOG_CHECK(check_stream(written[i]));
        for (const NamedPath& source : read) {
            if (std::ranges::any_of(files_of(source.path), [&](const std::string& file) {
                    return same_file(file, written[i].path);
                })) {
                return same(source, written[i], "; give another to write");
            }
        }
        for (std::size_t other = i + 1; other < written.size(); ++other) {
            if (same_file(written[i].path, written[other].path)) {
                return same(written[i], written[other], "");
            }
        }
    }
    for (const NamedPath& output : written) { GYROLOG_CHECK(try_to_write(output.path)); }
    return {};
}

Status check_ending(const NamedPath& written, const char* what, std::span<const char* const> endings) {
    const auto is_ending = [&](const char* ending) { return written.path.ends_with(ending); };
    if (written.path.empty() || std::ranges::any_of(endings, is_ending) || takes_anything(written.path)) {
        return {};
    }
    return invalid_argument(fmt::format("{} '{}' has none of the endings of {}: {}", written.option,
                                        written.path, what, fmt::join(endings, ", ")));
}

}  // namespace gyrolog
