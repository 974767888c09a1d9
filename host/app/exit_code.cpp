#include "host/app/exit_code.hpp"

namespace gyrolog {

ExitCode ended_by_signal(int number) {
    constexpr int of_a_shell = 128;
    return static_cast<ExitCode>(of_a_shell + number);
}

ExitCode exit_code_of(const Error& error) {
    switch (error.code) {
        case ErrorCode::invalid_argument:
            return ExitCode::usage;
        case ErrorCode::device_lost:
            return ExitCode::device_lost;
        case ErrorCode::disk_full:
            return ExitCode::disk_full;
        case ErrorCode::not_found:
        case ErrorCode::permission_denied:
        case ErrorCode::busy:
        case ErrorCode::storage_failed:
        case ErrorCode::malformed:
        case ErrorCode::unsupported:
        case ErrorCode::timeout:
        case ErrorCode::failed:
            break;
    }
    return ExitCode::failed;
}

ExitCode exit_code_of_opening(const Error& error) {
    switch (error.code) {
        case ErrorCode::not_found:
        case ErrorCode::permission_denied:
        case ErrorCode::busy:
        case ErrorCode::timeout:
            return ExitCode::no_device;
        default:
            return exit_code_of(error);
    }
}

}  // namespace gyrolog
