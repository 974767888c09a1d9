#include "host/capture/segment_files.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "host/capture/capture_reader.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view ending = ".pcapng";

std::string_view stem_of(std::string_view path) {
    return path.ends_with(ending) ? path.substr(0, path.size() - ending.size()) : path;
}

// What the file says of itself; nothing of one that cannot be read or is not this program's.
std::optional<CaptureSegment> segment_of(const std::string& path) {
    const auto reader = CaptureReader::open(path);
    if (!reader.ok() || !reader->metadata()) { return std::nullopt; }
    return reader->metadata()->segment;
}

// Whether `name` is `stem`, a dot, digits, and the ending of captures if `path` has it.
bool is_named_like_a_segment(std::string_view name, std::string_view first_name) {
    const std::string_view stem = stem_of(first_name);
    if (!name.starts_with(stem)) { return false; }
    std::string_view rest = name.substr(stem.size());
    if (first_name.ends_with(ending)) {
        if (!rest.ends_with(ending)) { return false; }
        rest.remove_suffix(ending.size());
    }
    return rest.size() > 1 && rest.front() == '.' &&
           std::ranges::all_of(rest.substr(1), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::string segment_path(const std::string& first_path, std::uint64_t number) {
    if (number == 1) { return first_path; }
    const std::string_view stem = stem_of(first_path);
    return std::string(stem) + "." + std::to_string(number) + first_path.substr(stem.size());
}

bool is_segment_path(const std::string& path, const std::string& first_path) {
    namespace fs = std::filesystem;
    std::error_code none;
    const fs::path whole = fs::weakly_canonical(fs::absolute(path, none), none);
    const fs::path first = fs::weakly_canonical(fs::absolute(first_path, none), none);
    return whole.parent_path() == first.parent_path() &&
           is_named_like_a_segment(whole.filename().string(), first.filename().string());
}

std::vector<std::string> segment_files(const std::string& first_path) {
    namespace fs = std::filesystem;
    std::error_code unknown;
    if (!fs::is_regular_file(first_path, unknown)) { return {first_path}; }
    const fs::path first(first_path);
    const std::string first_name = first.filename().string();
    std::vector<std::string> candidates;
    const fs::path folder = first.has_parent_path() ? first.parent_path() : fs::path(".");
    for (fs::directory_iterator entry(folder, unknown), end; !unknown && entry != end;
         entry.increment(unknown)) {
        const std::string name = entry->path().filename().string();
        if (is_named_like_a_segment(name, first_name)) {
            candidates.push_back(
                (first.has_parent_path() ? first.parent_path() / name : fs::path(name)).string());
        }
    }
    if (candidates.empty()) { return {first_path}; }
    const std::optional<CaptureSegment> begin = segment_of(first_path);
    if (!begin || begin->number != 1) { return {first_path}; }

    std::vector<std::pair<std::uint64_t, std::string>> found{{1, first_path}};
    for (const std::string& path : candidates) {
        const std::optional<CaptureSegment> part = segment_of(path);
        if (part && part->capture == begin->capture && part->number > 1) {
            found.emplace_back(part->number, path);
        }
    }
    std::ranges::sort(found);
    std::vector<std::string> files;
    files.reserve(found.size());
    for (auto& [number, path] : found) { files.push_back(std::move(path)); }
    return files;
}

}  // namespace gyrolog
