// Sensor models as JSON files, schema gyrolog-model/1, and what else a model can be read from.
//
// In the file angles are degrees and acceleration is g; in SensorModel everything is SI. Numbers read and
// written back unchanged are the same text value: each is written with the fewest digits that give back the
// SI number. Keys that this version does not know are kept and written back; a note names those that
// resemble one that it knows.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// What a model does not state and a recording can tell. Until it is told the rate is 0, there is no step and
// the range is `no_range_rad_s`.
struct Unstated {
    bool rate = false;
    bool step = false;
    bool full_scale = false;
    bool saturation = false;
};

// A model file with what a person should know about it.
struct ModelFile {
    SensorModel model;
    std::vector<std::string> notes;
    bool is_drawn = false;  // of a data sheet: another seed is another unit
    Unstated unstated{};
    // White noise of each axis that a file states by the sample and without a rate: N takes it up with the
    // rate.
    Vector3 unrated_sd_rad_s{};
};

// The rate of a model that does not state one.
void state_rate(ModelFile& file, double rate_hz);

// Takes what the model does not state from the recording, and adds a note of it.
void complete_from(const Recording& recording, ModelFile& file);

// A gyrolog-model/1; a data sheet (datasheet_json.hpp) or a population
// (population_json.hpp), from which `seed` draws a unit; or gyroparams
// (gyroparams_json.hpp). `name` is what errors call the text: the file's path.
// Of a gyrolog-model/1 `schema` and `axes` are needed, and of each axis N, B, K or bias; what else is not
// stated is zero and exactly known (M: the identity), or a recording's to tell. Notes say which. Errors:
// `malformed` for text that is no JSON, a missing needed key, a wrong type, a number that is not finite or
// out of its range, each naming the key; `unsupported` for another schema.
Result<ModelFile> parse_model_file(std::string_view text, const std::string& name, std::uint64_t seed);
// Whether all its numbers are finite, and in their ranges, in the units of the file as well.
bool can_be_written(const ModelFile& file);
// A model that stands for itself: without a rate it is `malformed`.
Result<SensorModel> parse_model(std::string_view text, const std::string& name, std::uint64_t seed = 1);
// Always as gyrolog-model/1.
std::string format_model(const SensorModel& model);

// The whole of a file that may be a model, or what errors call it. Error `malformed`: longer than any model.
Result<std::string> read_model_text(const std::string& path, const std::string& called = "model");

// Also `not_found`, `permission_denied`, `failed` as the file system has it; writing replaces the file.
Result<ModelFile> read_model_file(const std::string& path, std::uint64_t seed);
Result<SensorModel> read_model(const std::string& path, std::uint64_t seed = 1);
Status write_model(const SensorModel& model, const std::string& path);

}  // namespace gyrolog
