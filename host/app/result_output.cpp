#include "host/app/result_output.hpp"

#include <nlohmann/json.hpp>

#include "host/base/file_output.hpp"

namespace gyrolog {

Status write_json(Console& console, const std::string& path, const nlohmann::ordered_json& answer) {
    return write_text(console, path, answer.dump(2) + "\n");
}

Status write_text(Console& console, const std::string& path, const std::string& text) {
    if (path != "-") { return write_file(path, as_bytes(text)); }
    console.out << text << std::flush;
    if (!console.out.good()) { return Error{ErrorCode::storage_failed, "write to standard output failed"}; }
    return {};
}

}  // namespace gyrolog
