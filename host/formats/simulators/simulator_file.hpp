// A simulator's own file as a sensor model, and changed to what a model is now. What kind of file it is the
// text tells, not the name.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/result.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/simulators/simulator_source.hpp"

namespace gyrolog {

struct SimulatorFileKind {
    std::string_view called;                    // "an imu sensor of SDF"
    std::span<const std::string_view> endings;  // of such files' names
    SimulatorAbilities abilities;
};

class SimulatorFile {
public:
    virtual ~SimulatorFile() = default;

    // What its sensors are called, from the outside in, joined by "::"; one at least.
    virtual const std::vector<std::string>& sensors() const = 0;
    virtual const SimulatorFileKind& kind(std::size_t sensor) const = 0;
    // What the file states of the sensor; notes say what was taken for what, what a simulator takes where the
    // file does not state it, and what a model cannot hold. Error `malformed`: the element or key that is
    // wrong, and how.
    virtual Result<ModelFile> model(std::size_t sensor) const = 0;
    // The text with that sensor's numbers put to the source's, and the head as a comment at its beginning, in
    // the place of one that was put there before. All else stays. Error `unsupported`: the text is written in
    // a way that cannot be changed, with the reason.
    virtual Result<std::string> changed(std::size_t sensor, const SimulatorSource& source,
                                        std::span<const std::string> head) const = 0;
};

// Null for a text that is no simulator's. Error `malformed`: it is, and cannot be read, or no sensor is in
// it; the message says what is wrong.
Result<std::unique_ptr<SimulatorFile>> open_simulator_file(std::string_view text);

// Whether a file that begins so may be one.
bool begins_as_simulator_file(std::string_view text);

// Whether a comment is the head of a file that this program wrote: begins as head_lines() do.
bool is_own_head(std::string_view comment);

}  // namespace gyrolog
