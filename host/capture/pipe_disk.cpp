#include "host/capture/pipe_disk.hpp"

#include <cerrno>
#include <limits>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/capture/errno_error.hpp"

namespace gyrolog {
namespace {

class PipeFile final : public AppendFile {
public:
    PipeFile(int descriptor, std::string path, std::atomic<bool>& left)
        : descriptor_(descriptor), path_(std::move(path)), left_(left) {}
    PipeFile(const PipeFile&) = delete;
    PipeFile& operator=(const PipeFile&) = delete;
    ~PipeFile() override { static_cast<void>(close()); }

    Result<std::size_t> write(ByteView bytes) override {
        while (true) {
            const ssize_t taken = ::write(descriptor_, bytes.data(), bytes.size());
            if (taken > 0) { return static_cast<std::size_t>(taken); }
            if (errno == EINTR) { continue; }
            left_ = left_ || errno == EPIPE;
            return errno_error("write '" + path_ + "'");
        }
    }
    Status truncate(std::uint64_t /*size_bytes*/) override { return {}; }
    Status sync() override { return {}; }
    Status close() override {
        const int descriptor = std::exchange(descriptor_, -1);
        if (descriptor >= 0) { ::close(descriptor); }
        return {};
    }

private:
    int descriptor_;
    std::string path_;
    std::atomic<bool>& left_;
};

}  // namespace

Result<std::unique_ptr<PipeDisk>> PipeDisk::open(const std::string& path) {
    struct stat found {};
    if (::stat(path.c_str(), &found) != 0) { return errno_error("open pipe '" + path + "'"); }
    if (!S_ISFIFO(found.st_mode)) {
        return Error{ErrorCode::unsupported,
                     "open pipe '" + path + "': it is no named pipe (mkfifo makes one)"};
    }
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) { return errno_error("open pipe '" + path + "'"); }
    return std::unique_ptr<PipeDisk>(new PipeDisk(descriptor));
}

PipeDisk::~PipeDisk() {
    if (descriptor_ >= 0) { ::close(descriptor_); }
}

Result<std::unique_ptr<AppendFile>> PipeDisk::create(const std::string& path, IfExists /*if_exists*/) {
    const int descriptor = std::exchange(descriptor_, -1);
    if (descriptor < 0) {
        return Error{ErrorCode::storage_failed, "write '" + path + "': a pipe holds one file"};
    }
    return std::unique_ptr<AppendFile>(std::make_unique<PipeFile>(descriptor, path, left_));
}

Result<std::uint64_t> PipeDisk::free_bytes(const std::string& /*path*/) {
    return std::numeric_limits<std::uint64_t>::max();
}

}  // namespace gyrolog
