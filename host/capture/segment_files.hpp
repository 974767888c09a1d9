// The files of one capture: night.pcapng, night.2.pcapng, night.3.pcapng, ...
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gyrolog {

// "night.pcapng" and 2: "night.2.pcapng". 1 is the path itself.
std::string segment_path(const std::string& first_path, std::uint64_t number);

// The path, and behind it the other files of the same capture, in their order: those beside it with such a
// name whose section header names the same capture. Only the path for what is not the first file of a
// capture. A file of the middle may be missing: the stream then shows a gap.
std::vector<std::string> segment_files(const std::string& first_path);

// Whether the capture that begins with that file may go on in this one, or has.
bool is_segment_path(const std::string& path, const std::string& first_path);

}  // namespace gyrolog
