// The simulators that a model can be exported to. A simulator is one file, and one line in
// simulator_format.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "host/formats/simulators/simulator_source.hpp"

namespace gyrolog {

struct SimulatorFormat {
    std::string_view name;     // of --for
    std::string_view summary;  // what is written
    SimulatorAbilities abilities;
    // Conventions and faults of the simulator that a user has to know, each with where it was read.
    std::span<const std::string_view> facts;
    // The whole file, `head` in its comments.
    std::string (*text)(const SimulatorSource& source, std::span<const std::string> head);
};

std::span<const SimulatorFormat* const> simulator_formats();

// Null for an unknown name.
const SimulatorFormat* find_simulator_format(std::string_view name);

// The model as that simulator's file. The horizon is not below one sample of the model.
std::string simulator_text(const SimulatorFormat& format, const SensorModel& model, const std::string& name,
                           double horizon_s);

// The head as comments: each line behind `sign`.
std::string commented(std::span<const std::string> head, std::string_view sign);
// The same for Python, behind python_encoding_line.
std::string commented_for_python(std::span<const std::string> head);
// What stands in an XML comment, a line each.
std::string xml_comment(std::span<const std::string> head);

}  // namespace gyrolog
