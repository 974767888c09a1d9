#include "host/capture/append_file.hpp"

#include <cerrno>
#include <filesystem>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "host/base/replacing_file.hpp"
#include "host/capture/background_sync.hpp"
#include "host/capture/errno_error.hpp"

namespace gyrolog {
namespace {

class PosixAppendFile final : public AppendFile {
public:
    PosixAppendFile(int descriptor, std::string path, std::optional<ReplacingFile> replacing)
        : descriptor_(descriptor), path_(std::move(path)), replacing_(std::move(replacing)) {}
    PosixAppendFile(const PosixAppendFile&) = delete;
    PosixAppendFile& operator=(const PosixAppendFile&) = delete;
    ~PosixAppendFile() override {
        background_.reset();
        if (descriptor_ >= 0) { ::close(descriptor_); }
    }

    Result<std::size_t> write(ByteView bytes) override {
        while (true) {
            const ssize_t taken = ::write(descriptor_, bytes.data(), bytes.size());
            if (taken > 0) { return static_cast<std::size_t>(taken); }
            if (taken == 0) {
                return Error{ErrorCode::storage_failed, "write '" + path_ + "': nothing was taken"};
            }
            if (errno != EINTR) { return errno_error("write '" + path_ + "'"); }
        }
    }

    Status truncate(std::uint64_t size_bytes) override {
        while (::ftruncate(descriptor_, static_cast<off_t>(size_bytes)) != 0) {
            if (errno != EINTR) { return errno_error("truncate '" + path_ + "'"); }
        }
        return {};
    }

    Status sync() override {
        const int earlier = background_ ? background_->wait() : 0;
        return sync_status(earlier != 0 ? earlier : sync_data(descriptor_));
    }

    Status begin_sync() override {
        if (!background_) { background_ = std::make_unique<BackgroundSync>(descriptor_); }
        return sync_status(background_->begin());
    }

    Status take_place() override {
        if (!replacing_) { return {}; }
        Status placed = replacing_->take_place();
        return placed.ok() ? placed
                           : Status(in_context("replace '" + path_ + "'", std::move(placed).error()));
    }

    Status close() override {
        replacing_.reset();
        background_.reset();
        const int descriptor = descriptor_;
        descriptor_ = -1;
        // After EINTR the descriptor is gone all the same (Linux).
        if (descriptor >= 0 && ::close(descriptor) != 0 && errno != EINTR) {
            return errno_error("close '" + path_ + "'");
        }
        return {};
    }

private:
    Status sync_status(int error_number) const {
        if (error_number == 0) { return {}; }
        errno = error_number;
        return errno_error("sync '" + path_ + "'");
    }

    int descriptor_;
    std::string path_;
    std::optional<ReplacingFile> replacing_;
    std::unique_ptr<BackgroundSync> background_;
};

std::string directory_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

Status sync_directory_of(const std::string& path) {
    const std::string directory = directory_of(path);
    const int descriptor = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) { return errno_error("open directory '" + directory + "'"); }
    const bool synced = ::fsync(descriptor) == 0 || errno == EINVAL;
    Status status = synced ? Status() : Status(errno_error("sync directory '" + directory + "'"));
    ::close(descriptor);
    return status;
}

class ComputersDisk final : public Disk {
public:
    Result<std::unique_ptr<AppendFile>> create(const std::string& path, IfExists if_exists) override {
        return create_append_file(path, if_exists);
    }
    Result<std::uint64_t> free_bytes(const std::string& path) override {
        struct statvfs disk {};
        const std::string directory = directory_of(path);
        if (::statvfs(directory.c_str(), &disk) != 0) {
            return errno_error("ask for the room on the disk of '" + directory + "'");
        }
        return std::uint64_t{disk.f_bavail} * disk.f_frsize;
    }
};

}  // namespace

Result<std::unique_ptr<AppendFile>> create_append_file(const std::string& path, IfExists if_exists) {
    namespace fs = std::filesystem;
    std::error_code unknown;
    const auto there = fs::status(path, unknown);
    // A link is replaced and not followed, also one to nothing. A pipe or a device takes what is written.
    const bool is_replaced = fs::is_regular_file(there) ||
                             (!fs::exists(there) && fs::is_symlink(fs::symlink_status(path, unknown)));
    if (if_exists == IfExists::replace && is_replaced) {
        auto replacing = ReplacingFile::create(path);
        if (!replacing.ok()) { return in_context("create '" + path + "'", std::move(replacing).error()); }
        const int descriptor = ::fcntl(replacing->descriptor(), F_DUPFD_CLOEXEC, 0);
        if (descriptor < 0) { return errno_error("create '" + path + "'"); }
        return std::unique_ptr<AppendFile>(
            std::make_unique<PosixAppendFile>(descriptor, path, std::move(replacing).value()));
    }
    const bool is_new = if_exists == IfExists::refuse || !fs::exists(there);
    const int creating = is_new ? O_CREAT | O_EXCL : 0;
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | creating, 0666);
    if (descriptor < 0) { return errno_error("create '" + path + "'"); }
    auto file = std::make_unique<PosixAppendFile>(descriptor, path, std::nullopt);
    GYROLOG_CHECK(sync_directory_of(path));
    return std::unique_ptr<AppendFile>(std::move(file));
}

Disk& computers_disk() {
    static ComputersDisk disk;
    return disk;
}

}  // namespace gyrolog
