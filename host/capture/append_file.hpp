// The end of a file that only grows: all that a writer needs of a disk, and small enough to fake.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

class AppendFile {
public:
    virtual ~AppendFile() = default;

    // Returns how many bytes were taken: at least one, and fewer than given when the disk is filling up.
    // Errors: disk_full, storage_failed.
    virtual Result<std::size_t> write(ByteView bytes) = 0;
    virtual Status truncate(std::uint64_t size_bytes) = 0;
    // Everything written so far survives a loss of power.
    virtual Status sync() = 0;
    // The same soon, without waiting for it. A failure is told by the next call of this or of sync().
    virtual Status begin_sync() { return sync(); }
    // A file that is to replace another stands beside it until then, and is gone if it is closed before.
    virtual Status take_place() { return {}; }
    virtual Status close() = 0;
};

enum class IfExists { refuse, replace };

// The new file's name survives a loss of power, too. Errors: invalid_argument when it exists, not_found,
// permission_denied, disk_full, storage_failed.
Result<std::unique_ptr<AppendFile>> create_append_file(const std::string& path, IfExists if_exists);

// Where files are made. A seam: tests put a disk behind it that fails as they want.
class Disk {
public:
    virtual ~Disk() = default;
    virtual Result<std::unique_ptr<AppendFile>> create(const std::string& path, IfExists if_exists) = 0;
    // What a program that is not root may still write beside this path.
    virtual Result<std::uint64_t> free_bytes(const std::string& path) = 0;
};

Disk& computers_disk();

}  // namespace gyrolog
