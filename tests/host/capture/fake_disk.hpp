// A disk in memory that behaves as badly as it is told.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "host/capture/append_file.hpp"

namespace gyrolog {

struct FakeDisk {
    Bytes contents;
    std::size_t synced_bytes = 0;
    std::size_t capacity_bytes = std::numeric_limits<std::size_t>::max();
    std::size_t bytes_per_write = std::numeric_limits<std::size_t>::max();  // more is taken in part
    std::optional<Error> sync_error;
    std::optional<Error> truncate_error;
    int writes_after_failure = 0;
    bool failed = false;
    bool closed = false;

    std::unique_ptr<AppendFile> open();
};

class FakeDiskFile final : public AppendFile {
public:
    explicit FakeDiskFile(FakeDisk& disk) : disk_(disk) {}

    Result<std::size_t> write(ByteView bytes) override {
        if (disk_.failed) { ++disk_.writes_after_failure; }
        const std::size_t room = disk_.capacity_bytes - std::min(disk_.capacity_bytes, disk_.contents.size());
        const std::size_t taken = std::min({bytes.size(), room, disk_.bytes_per_write});
        if (taken == 0) {
            disk_.failed = true;
            return Error{ErrorCode::disk_full, "write: no space left on device"};
        }
        disk_.contents.insert(disk_.contents.end(), bytes.begin(),
                              bytes.begin() + static_cast<std::ptrdiff_t>(taken));
        return taken;
    }

    Status truncate(std::uint64_t size_bytes) override {
        if (disk_.truncate_error) { return *disk_.truncate_error; }
        disk_.contents.resize(static_cast<std::size_t>(size_bytes));
        return {};
    }

    Status sync() override {
        if (disk_.sync_error) { return *disk_.sync_error; }
        disk_.synced_bytes = disk_.contents.size();
        return {};
    }

    Status close() override {
        disk_.closed = true;
        return {};
    }

private:
    FakeDisk& disk_;
};

inline std::unique_ptr<AppendFile> FakeDisk::open() { return std::make_unique<FakeDiskFile>(*this); }

}  // namespace gyrolog
