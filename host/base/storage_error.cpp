#include "host/base/storage_error.hpp"

#include <cerrno>
#include <cstring>

namespace gyrolog {

Error storage_error(int number) {
    switch (number) {
        case ENOSPC:
        case EDQUOT:
            return {ErrorCode::disk_full, "disk full"};
        case EFBIG:
            return {ErrorCode::disk_full, "the file has reached the limit for files (ulimit -f)"};
        case ENOENT:
        case ENOTDIR:
            return {ErrorCode::not_found, "no such directory"};
        case EISDIR:
            return {ErrorCode::storage_failed, "it is a directory"};
        case EACCES:
        case EPERM:
            return {ErrorCode::permission_denied, "permission denied"};
        default:
            return {number == EROFS ? ErrorCode::permission_denied : ErrorCode::storage_failed,
                    std::strerror(number)};
    }
}

}  // namespace gyrolog
