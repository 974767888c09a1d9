#include "host/capture/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace gyrolog {
namespace {

Error reading_error(const std::string& what) {
    const int error_number = errno;
    const ErrorCode code = error_number == ENOENT || error_number == ENOTDIR ? ErrorCode::not_found
                           : error_number == EACCES                          ? ErrorCode::permission_denied
                                                                             : ErrorCode::failed;
    return {code, what + ": " + std::generic_category().message(error_number)};
}

class PosixInputFile final : public InputFile {
public:
    PosixInputFile(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}
    PosixInputFile(const PosixInputFile&) = delete;
    PosixInputFile& operator=(const PosixInputFile&) = delete;
    ~PosixInputFile() override { ::close(descriptor_); }

    Status measure() {
        struct stat status {};
        if (::fstat(descriptor_, &status) != 0) { return reading_error("open '" + path_ + "'"); }
        if (!S_ISREG(status.st_mode)) {
            return Error{ErrorCode::unsupported, "open '" + path_ + "': not a regular file"};
        }
        size_bytes_ = static_cast<std::uint64_t>(status.st_size);
        return {};
    }

    std::uint64_t size_bytes() const override { return size_bytes_; }

    Result<std::size_t> read_at(std::uint64_t offset, std::span<std::uint8_t> out) override {
        std::size_t filled = 0;
        while (filled < out.size()) {
            const ssize_t got = ::pread(descriptor_, out.data() + filled, out.size() - filled,
                                        static_cast<off_t>(offset + filled));
            if (got == 0) { break; }
            if (got < 0 && errno == EINTR) { continue; }
            if (got < 0) { return reading_error("read '" + path_ + "'"); }
            filled += static_cast<std::size_t>(got);
        }
        return filled;
    }

private:
    int descriptor_;
    std::string path_;
    std::uint64_t size_bytes_ = 0;
};

class MemoryInputFile final : public InputFile {
public:
    explicit MemoryInputFile(Bytes contents) : contents_(std::move(contents)) {}

    std::uint64_t size_bytes() const override { return contents_.size(); }

    Result<std::size_t> read_at(std::uint64_t offset, std::span<std::uint8_t> out) override {
        if (offset >= contents_.size()) { return std::size_t{0}; }
        const std::size_t count = std::min(out.size(), contents_.size() - static_cast<std::size_t>(offset));
        std::copy_n(contents_.begin() + static_cast<std::ptrdiff_t>(offset), count, out.begin());
        return count;
    }

private:
    Bytes contents_;
};

}  // namespace

Result<std::unique_ptr<InputFile>> open_input_file(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) { return reading_error("open '" + path + "'"); }
    auto file = std::make_unique<PosixInputFile>(descriptor, path);
    GYROLOG_CHECK(file->measure());
    return std::unique_ptr<InputFile>(std::move(file));
}

std::unique_ptr<InputFile> input_from_memory(Bytes contents) {
    return std::make_unique<MemoryInputFile>(std::move(contents));
}

}  // namespace gyrolog
