#include "host/capture/errno_error.hpp"

#include <cerrno>
#include <system_error>

namespace gyrolog {
namespace {

ErrorCode code_of(int error_number) {
    switch (error_number) {
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
            return ErrorCode::disk_full;
        case ENOENT:
        case ENOTDIR:
            return ErrorCode::not_found;
        case EACCES:
        case EPERM:
        case EROFS:
            return ErrorCode::permission_denied;
        case EEXIST:
            return ErrorCode::invalid_argument;
        default:
            return ErrorCode::storage_failed;
    }
}

}  // namespace

Error errno_error(const std::string& what) {
    const int error_number = errno;
    return {code_of(error_number), what + ": " + std::generic_category().message(error_number)};
}

}  // namespace gyrolog
