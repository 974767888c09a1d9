// Models from any file that has one: gyrolog's own (model_json.hpp), and other simulators' (SDF, the imu
// plugins of PX4 and RotorS, MJCF, AirSim's settings, Kalibr's imu.yaml), told by the text.
//
// Of a file with several sensors one is named behind the path: "robot.sdf#imu_link::imu", or as much of the
// end of that name as tells it from the others. A file whose own name has a '#' comes first.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "host/base/result.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/simulators/simulator_file.hpp"

namespace gyrolog {

struct ModelPath {
    std::string file;
    std::string sensor;  // empty: not named
};

ModelPath model_path(const std::string& text);

// Whether a file is read as a model rather than as a recording: by its ending .json, or its content.
bool is_model_file(const std::string& path);

struct ModelSource {
    ModelFile file;
    std::string file_path;
    std::string name;                                     // of the file without its folders, and the sensor
    std::shared_ptr<const SimulatorFile> simulator = {};  // null: gyrolog's own
    std::size_t sensor = 0;                               // of it
};

// Errors as read_model_file(); also `invalid_argument`: several sensors and none named, or none of that name,
// with the names that there are.
Result<ModelSource> read_model_source(const std::string& path, std::uint64_t seed);
Result<ModelSource> parse_model_source(const std::string& text, const ModelPath& path, std::uint64_t seed);

// A simulator's file with the model's numbers in it.
struct ChangedFile {
    std::string text;
    std::vector<std::string> told;  // of what is approximated there, and what it cannot take
};

// `from`: what the head says of where the numbers are from. The horizon as simulator_text() has it. Errors:
// `invalid_argument` where the model's rate is not known; `unsupported` as SimulatorFile::changed(), also
// where the file, read again, is not what was to be written.
Result<ChangedFile> changed_simulator_file(const ModelSource& source, const SensorModel& model,
                                           const std::string& from, double horizon_s);

}  // namespace gyrolog
