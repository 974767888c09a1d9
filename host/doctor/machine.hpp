// The machine as the doctor sees it: files below one root, and what no file tells.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/base/result.hpp"

namespace gyrolog {

struct Machine {
    std::string root = "/";        // /sys, /proc, /etc ... are looked for below it
    std::string folder = ".";      // where captures would be written
    std::string user;              // their name; empty: not known
    bool is_root = false;          // may do everything
    std::vector<unsigned> groups;  // that this process has
    std::string seat;              // "seat0" of somebody who sits at the machine; empty over ssh
    std::string kernel_release;    // "6.1.0-18-amd64"
    std::int64_t now_s = 0;        // since the Unix epoch
    std::function<bool(const std::string& path)> may_open;  // to read and to write
    std::function<Result<std::uint64_t>(const std::string& folder)> free_bytes;
    std::function<Result<double>(const std::string& folder)> sync_s;  // the longest of a few

    std::string at(const std::string& path) const;  // "/sys/x" below the root
    bool has(const std::string& path) const;
    // Of its beginning, a megabyte at most; empty where it cannot be read.
    std::string text(const std::string& path) const;
    // Names in a folder, sorted.
    std::vector<std::string> names(const std::string& path) const;
};

// The computer that this runs on. `root` other than "/": the files of another one, that is mounted there.
Machine this_machine(const std::string& root = "/");

}  // namespace gyrolog
