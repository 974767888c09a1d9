#include "host/app/result_output.hpp"

#include <cerrno>

#include <nlohmann/json.hpp>

#include "host/base/file_output.hpp"
#include "host/base/program_name.hpp"

namespace gyrolog {

Status write_json(Console& console, const std::string& path, nlohmann::ordered_json answer) {
    answer["reported_by"] = program_name();
    return write_text(console, path, answer.dump(2) + "\n");
}

Status write_text(Console& console, const std::string& path, const std::string& text) {
    if (path != "-") { return write_file(path, as_bytes(text)); }
    errno = 0;
    console.out << text << std::flush;
    if (console.out.good()) { return {}; }
    // A stream keeps no reason, but the write that failed has just left one.
    if (errno == ENOSPC) { return Error{ErrorCode::disk_full, "write to standard output: disk full"}; }
    return Error{ErrorCode::storage_failed, "write to standard output failed"};
}

}  // namespace gyrolog
