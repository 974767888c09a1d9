#include "host/doctor/machine.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <pwd.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "host/base/clock.hpp"
#include "host/base/replacing_file.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t text_bytes_most = std::size_t{1} << 20;

Result<std::uint64_t> free_bytes_in(const std::string& folder) {
    std::error_code problem;
    const fs::space_info space = fs::space(folder, problem);
    if (problem) { return Error{ErrorCode::failed, problem.message()}; }
    return std::uint64_t{space.available};
}

// As a capture does it: a block each, and the disk is asked for it.
Result<double> longest_sync_in(const std::string& folder) {
    constexpr int syncs = 8;
    constexpr std::size_t block_bytes = 65536;
    const std::vector<std::uint8_t> block(block_bytes, 0x5A);
    GYROLOG_TRY(ReplacingFile file, ReplacingFile::create(folder + "/gyrolog-doctor"));
    double longest_s = 0.0;
    for (int i = 0; i < syncs; ++i) {
        GYROLOG_CHECK(file.write(block));
        const auto began = std::chrono::steady_clock::now();
        if (::fsync(file.descriptor()) != 0) { return Error{ErrorCode::storage_failed, "the disk refused"}; }
        longest_s = std::max(longest_s,
                             std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
    }
    return longest_s;  // without commit() nothing is left of the file
}

std::string name_of_user() {
    const passwd* entry = ::getpwuid(::geteuid());
    return entry == nullptr ? std::string() : entry->pw_name;
}

std::vector<unsigned> groups_of_process() {
    const int count = ::getgroups(0, nullptr);
    std::vector<gid_t> groups(static_cast<std::size_t>(std::max(count, 0)));
    if (count > 0 && ::getgroups(count, groups.data()) < 0) { groups.clear(); }
    std::vector<unsigned> all(groups.begin(), groups.end());
    all.push_back(::getegid());
    return all;
}

}  // namespace

std::string Machine::at(const std::string& path) const {
    return (fs::path(root) / fs::path(path).relative_path()).string();
}

bool Machine::has(const std::string& path) const {
    std::error_code none;
    return fs::exists(at(path), none);
}

std::string Machine::text(const std::string& path) const {
    std::ifstream file(at(path), std::ios::binary);
    std::string text(text_bytes_most, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    return text;
}

std::vector<std::string> Machine::names(const std::string& path) const {
    std::error_code none;
    std::vector<std::string> found;
    for (fs::directory_iterator entry(at(path), none), end; entry != end; entry.increment(none)) {
        found.push_back(entry->path().filename().string());
        if (none) { break; }
    }
    std::ranges::sort(found);
    return found;
}

Machine this_machine(const std::string& root) {
    Machine machine;
    machine.root = root;
    machine.user = name_of_user();
    machine.is_root = ::geteuid() == 0;
    machine.groups = groups_of_process();
    const char* seat = std::getenv("XDG_SEAT");
    machine.seat = seat == nullptr ? "" : seat;
    utsname kernel{};
    if (::uname(&kernel) == 0) { machine.kernel_release = kernel.release; }
    machine.now_s = clock_ns(CLOCK_REALTIME) / 1'000'000'000;
    machine.may_open = [](const std::string& path) {
        return ::faccessat(AT_FDCWD, path.c_str(), R_OK | W_OK, AT_EACCESS) == 0;
    };
    machine.free_bytes = free_bytes_in;
    machine.sync_s = longest_sync_in;
    return machine;
}

}  // namespace gyrolog
