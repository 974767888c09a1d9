// What a stored capture holds and whether it is whole, as JSON and for people.
#pragma once

#include <string>
#include <vector>

#include "host/formats/json_fwd.hpp"
#include "host/formats/labelled_line.hpp"
#include "host/session/load_capture.hpp"

namespace gyrolog {

// gyrolog-check/1 and gyrolog-info/1. `path` is what the user typed.
Json check_json(const std::string& path, const LoadedCapture& capture);
Json info_json(const std::string& path, const LoadedCapture& capture);

std::string check_text(const std::string& path, const LoadedCapture& capture);
std::string info_text(const std::string& path, const LoadedCapture& capture);
// The lines of that text.
std::vector<LabelledLine> info_lines(const std::string& path, const LoadedCapture& capture);

// The board's serial number; of a virtual one, which all have the same, its URI, which tells the seed. Empty:
// not known.
std::string board_name(const LoadedCapture& capture);

// "2026-11-21T05:04:55.123456789Z"; empty: not known.
std::string started_utc(const LoadedCapture& capture);

// "no sample", "12 samples in 3 dropouts".
std::string missing_text(const LinkReport& link);

// Nothing of what the board sent is known to be missing.
bool nothing_missing(const LoadedCapture& capture);

}  // namespace gyrolog
