// A kind of element that is an imu sensor of some simulator in XML. A kind stands in its simulator's file,
// and in one line of xml_sensors.cpp.
#pragma once

#include <pugixml.hpp>

#include "host/formats/simulators/simulator_file.hpp"

namespace gyrolog {

struct XmlSensorKind {
    SimulatorFileKind kind;
    bool (*is)(const pugi::xml_node& element);
    // As SimulatorFile::model().
    Result<ModelFile> (*read)(const pugi::xml_node& element);
    // Its numbers become the source's.
    void (*change)(pugi::xml_node element, const SimulatorSource& source);
    // The comment that follows the head; null: none.
    std::string (*footnote)(const SimulatorSource& source) = nullptr;
};

extern const XmlSensorKind sdf_sensor;
extern const XmlSensorKind px4_plugin;
extern const XmlSensorKind rotors_plugin;
extern const XmlSensorKind mjcf_gyro;

// A file made of the text, which holds one sensor of the kind, with the source's numbers in it: so files for
// simulators are written in one way, whether new or a user's.
std::string xml_made(const XmlSensorKind& kind, std::string_view skeleton, const SimulatorSource& source,
                     std::span<const std::string> head);

}  // namespace gyrolog
