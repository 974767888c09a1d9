#include "host/base/file_output.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace gyrolog {
namespace {

Error storage_error(const std::string& path, int number) {
    ErrorCode code = ErrorCode::storage_failed;
    if (number == ENOSPC || number == EDQUOT) { code = ErrorCode::disk_full; }
    if (number == ENOENT || number == ENOTDIR) { code = ErrorCode::not_found; }
    if (number == EACCES || number == EPERM || number == EROFS) { code = ErrorCode::permission_denied; }
    return {code, "write '" + path + "': " + std::strerror(number)};
}

// Zero, or the errno of the first call that failed.
int write_all(int descriptor, ByteView contents) {
    while (!contents.empty()) {
        const ssize_t written = ::write(descriptor, contents.data(), contents.size());
        if (written < 0) {
            if (errno == EINTR) { continue; }
            return errno;
        }
        contents = contents.subspan(static_cast<std::size_t>(written));
    }
    return 0;
}

}  // namespace

Status write_file(const std::string& path, ByteView contents) {
    struct stat existing {};
    const bool exists = ::stat(path.c_str(), &existing) == 0;
    const bool direct = exists && !S_ISREG(existing.st_mode);
    const std::string written_path = direct ? path : path + ".part";
    const int flags = O_WRONLY | O_CLOEXEC | (direct ? 0 : O_CREAT | O_TRUNC);
    const int descriptor = ::open(written_path.c_str(), flags, exists ? existing.st_mode & 0777U : 0666U);
    if (descriptor < 0) { return storage_error(path, errno); }
    int problem = write_all(descriptor, contents);
    if (problem == 0 && !direct && ::fdatasync(descriptor) != 0) { problem = errno; }
    if (::close(descriptor) != 0 && problem == 0) { problem = errno; }
    if (problem == 0 && !direct && ::rename(written_path.c_str(), path.c_str()) != 0) { problem = errno; }
    if (problem == 0) { return {}; }
    if (!direct) { static_cast<void>(::unlink(written_path.c_str())); }
    return storage_error(path, problem);
}

}  // namespace gyrolog
