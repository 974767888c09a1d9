#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "host/base/printable.hpp"
#include "host/formats/input_limits.hpp"
#include "host/formats/simulators/simulator_format.hpp"
#include "host/formats/simulators/simulator_texts.hpp"
#include "host/formats/simulators/xml_edit.hpp"
#include "host/formats/simulators/xml_sensor.hpp"

namespace gyrolog {
namespace {

constexpr const XmlSensorKind* kinds[] = {&sdf_sensor, &px4_plugin, &rotors_plugin, &mjcf_gyro};

struct FoundSensor {
    pugi::xml_node element;
    const XmlSensorKind* kind;
};

class SensorSearch final : public pugi::xml_tree_walker {
public:
    bool for_each(pugi::xml_node& node) override {
        if (node.type() != pugi::node_element) { return true; }
        for (const XmlSensorKind* kind : kinds) {
            if (!kind->is(node)) { continue; }
            found.push_back({node, kind});
            break;
        }
        return true;
    }
    std::vector<FoundSensor> found;
};

std::vector<FoundSensor> sensors_in(pugi::xml_document& document) {
    SensorSearch search;
    document.traverse(search);
    return std::move(search.found);
}

constexpr std::size_t name_bytes_most = 120;

// The names of what it stands in, or what that refers to (URDF's gazebo), and its own.
std::string name_of(pugi::xml_node element) {
    std::string name;
    for (; element; element = element.parent()) {
        const pugi::xml_attribute called = element.attribute("name");
        const std::string_view own = (called ? called : element.attribute("reference")).value();
        if (own.empty()) { continue; }
        if (name.size() > name_bytes_most) { return "..." + name; }
        if (!name.empty()) { name.insert(0, "::"); }
        name.insert(0, printable(own.substr(0, name_bytes_most)));
    }
    return name;
}

// Sensors with one name, or without any, are told apart by their order: "r::imu[1]", "r::imu[2]".
std::vector<std::string> told_apart(std::vector<std::string> names) {
    std::map<std::string, std::pair<std::size_t, std::size_t>> seen;  // how many, and how many so far
    for (const std::string& name : names) { ++seen[name].first; }
    for (std::string& name : names) {
        auto& [all, so_far] = seen.at(name);
        if (all > 1) { name += fmt::format("[{}]", ++so_far); }
    }
    return names;
}

void put_head_of(const XmlSensorKind& kind, const SimulatorSource& source, std::span<const std::string> head,
                 pugi::xml_document& document) {
    put_head(document, xml_comment(head), kind.footnote == nullptr ? "" : kind.footnote(source));
}

class XmlSensors final : public SimulatorFile {
public:
    XmlSensors(std::unique_ptr<pugi::xml_document> document, std::vector<FoundSensor> found)
        : document_(std::move(document)), found_(std::move(found)) {
        for (const FoundSensor& sensor : found_) { names_.push_back(name_of(sensor.element)); }
        names_ = told_apart(names_);
    }

    const std::vector<std::string>& sensors() const override { return names_; }
    const SimulatorFileKind& kind(std::size_t sensor) const override { return found_.at(sensor).kind->kind; }
    Result<ModelFile> model(std::size_t sensor) const override {
        return found_.at(sensor).kind->read(found_.at(sensor).element);
    }
    Result<std::string> changed(std::size_t sensor, const SimulatorSource& source,
                                std::span<const std::string> head) const override {
        pugi::xml_document copy;
        copy.reset(*document_);
        const FoundSensor of_copy = sensors_in(copy).at(sensor);
        of_copy.kind->change(of_copy.element, source);
        put_head_of(*of_copy.kind, source, head, copy);
        return xml_text(copy);
    }

private:
    std::unique_ptr<pugi::xml_document> document_;
    std::vector<FoundSensor> found_;
    std::vector<std::string> names_;
};

Result<std::unique_ptr<SimulatorFile>> open_xml_sensors(std::string_view text) {
    GYROLOG_TRY(std::unique_ptr<pugi::xml_document> document, parse_xml(text));
    std::vector<FoundSensor> found = sensors_in(*document);
    if (found.empty()) {
        const std::string root = document->document_element().name();
        return malformed(
            "no imu sensor is in it" + (root.empty() ? "" : " (its root is <" + printable(root) + ">)") +
            ": neither <sensor type=\"imu\"> (SDF), nor an imu plugin with gyroscopeNoiseDensity "
            "(PX4, RotorS), nor a <gyro> in <sensor> (MuJoCo)");
    }
    if (found.size() > input_limits.xml_sensors_most) {
        return malformed(fmt::format("more than {} imu sensors", input_limits.xml_sensors_most));
    }
    return std::unique_ptr<SimulatorFile>(
        std::make_unique<XmlSensors>(std::move(document), std::move(found)));
}

bool begins_as_xml(std::string_view text) { return without_leading_blanks(text).starts_with('<'); }

}  // namespace

constinit const SimulatorText xml_sensors_text = {begins_as_xml, open_xml_sensors};

std::string xml_made(const XmlSensorKind& kind, std::string_view skeleton, const SimulatorSource& source,
                     std::span<const std::string> head) {
    const auto document = parse_xml(skeleton);
    pugi::xml_document& made = *document.value();
    kind.change(sensors_in(made).at(0).element, source);
    put_head_of(kind, source, head, made);
    return xml_text(made);
}

}  // namespace gyrolog
