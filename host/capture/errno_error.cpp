#include "host/capture/errno_error.hpp"

#include <cerrno>
#include <system_error>

#include "host/base/storage_error.hpp"

namespace gyrolog {

Error errno_error(const std::string& what) {
    const int error_number = errno;
    const ErrorCode code =
        error_number == EEXIST ? ErrorCode::invalid_argument : storage_error(error_number).code;
    return {code, what + ": " + std::generic_category().message(error_number)};
}

}  // namespace gyrolog
