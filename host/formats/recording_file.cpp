#include "host/formats/recording_file.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "host/formats/recording_csv.hpp"
#include "host/formats/recording_mat_read.hpp"
#include "host/formats/recording_npy.hpp"

namespace gyrolog {
namespace {

// What is read from a pipe is gone for whoever reads it next.
std::string beginning_of(const std::string& path) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(path, unknown)) { return {}; }
    std::array<char, 8> begin{};
    std::ifstream file(path, std::ios::binary);
    file.read(begin.data(), begin.size());
    return {begin.data(), static_cast<std::size_t>(file.gcount())};
}

}  // namespace

Result<Recording> read_recording_file(const std::string& path, const RecordingReadOptions& options) {
    const std::string begin = beginning_of(path);
    if (begins_as_npy(begin)) { return read_recording_npy(path, options); }
    if (begin.starts_with("MATLAB ")) { return read_recording_mat(path, options); }
    if (begin.starts_with("PK\x03\x04")) {
        return malformed(
            "read '" + path +
            "': this is an archive (.npz, .zip, .xlsx): take one table out of it, as .csv or .npy");
    }
    if (!begin.empty() && path.ends_with(".npy")) { return read_recording_npy(path, options); }
    // Level 4 begins with numbers; text in a .mat is what `save -ascii` of MATLAB writes.
    const bool is_binary = std::ranges::any_of(begin, [](unsigned char byte) { return byte < 7; });
    if (is_binary && path.ends_with(".mat")) { return read_recording_mat(path, options); }
    return read_recording_csv(path, options);
}

}  // namespace gyrolog
