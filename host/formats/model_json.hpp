// Sensor models as JSON files, schema gyrolog-model/1.
//
// In the file angles are degrees and acceleration is g; in SensorModel everything is SI. Numbers read and
// written back unchanged are the same text value: each is written with the fewest digits that give back the
// SI number. Keys that this version does not know are kept and written back.
#pragma once

#include <string>
#include <string_view>

#include "analysis/simulate/sensor_model.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// `name` is what errors call the text: the file's path.
// Errors: `malformed` for text that is no JSON, a missing needed key, a wrong type, a number that is not
// finite or out of its range, each naming the key; `unsupported` for another schema.
Result<SensorModel> parse_model(std::string_view text, const std::string& name);
std::string format_model(const SensorModel& model);

// Also `not_found`, `permission_denied`, `failed` as the file system has it; writing replaces the file.
Result<SensorModel> read_model(const std::string& path);
Status write_model(const SensorModel& model, const std::string& path);

}  // namespace gyrolog
