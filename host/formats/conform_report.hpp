// What a conformance run found, for people and for programs.
//
// {"schema": "gyrolog-conform/1", "device": URI, "board": {"firmware", "sensor", "uid", "boot_id"} or null,
//  "conforms": true|false, "broken_off": "" or why the conversation ended early,
//  "passed": n, "failed": n, "not_tested": n,
//  "rules": [{"rule": "8.4", "title": ..., "verdict": "pass" | "fail" | "not_tested",
//             "why": ...                                            of not_tested
//             "expected", "came", "bytes": hex, "at_s", "times"}]}  of fail: the first time, and how often
//
// `bytes` is the COBS form of the frame that is wrong, without delimiters, or the bytes sent that were not
// answered.
#pragma once

#include <string>

#include "host/conform/conformance.hpp"
#include "host/formats/json_fwd.hpp"

namespace gyrolog {

Json conform_json(const ConformanceReport& report);
std::string conform_text(const ConformanceReport& report);
// The whole conversation, a line a frame, with its bytes.
std::string transcript_text(const Dialogue& dialogue);

}  // namespace gyrolog
