// A named pipe in the place of a file: its reader sees the capture while it is made.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "host/capture/append_file.hpp"

namespace gyrolog {

// Makes one file, which cannot be cut back nor synced: both are done as far as the writer is concerned. A
// reader that does not read keeps the writer waiting.
class PipeDisk final : public Disk {
public:
    // Waits until somebody opens the pipe's other end. Errors: not_found, permission_denied, storage_failed;
    // unsupported for what is no named pipe.
    static Result<std::unique_ptr<PipeDisk>> open(const std::string& path);

    PipeDisk(const PipeDisk&) = delete;
    PipeDisk& operator=(const PipeDisk&) = delete;
    ~PipeDisk() override;

    // Error storage_failed when it has made its file.
    Result<std::unique_ptr<AppendFile>> create(const std::string& path, IfExists if_exists) override;
    // A pipe is never full for long.
    Result<std::uint64_t> free_bytes(const std::string& path) override;

    // The reader has closed its end: every write since then has failed.
    bool is_left() const { return left_; }

private:
    explicit PipeDisk(int descriptor) : descriptor_(descriptor) {}

    int descriptor_;  // -1: the file has it
    std::atomic<bool> left_{false};
};

}  // namespace gyrolog
