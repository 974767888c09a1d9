#include "host/app/exit_code.hpp"

#include <algorithm>
#include <array>

namespace gyrolog {

ExitCode ended_by_signal(int number) {
    constexpr int of_a_shell = 128;
    return static_cast<ExitCode>(of_a_shell + number);
}

ExitCode worst_of(ExitCode a, ExitCode b) {
    constexpr std::array from_best{ExitCode::ok,          ExitCode::data_lost, ExitCode::not_conforming,
                                   ExitCode::failed,      ExitCode::usage,     ExitCode::no_device,
                                   ExitCode::device_lost, ExitCode::disk_full};
    const auto place = [&](ExitCode code) { return std::ranges::find(from_best, code); };
    return place(b) > place(a) ? b : a;
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
