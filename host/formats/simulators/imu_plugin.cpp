#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/formats/simulators/imported_model.hpp"
#include "host/formats/simulators/simulators.hpp"
#include "host/formats/simulators/xml_edit.hpp"
#include "host/formats/simulators/xml_sensor.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view px4_facts[] = {
    "Densities, two-sided, of a sample each simulation step; the bias is a Gauss-Markov process that begins "
    "at "
    "zero and is driven by gyroscopeRandomWalk (PX4-SITL_gazebo-classic, src/gazebo_imu_plugin.cpp, "
    "addNoise, "
    "03fa8f2970dd).",
    "The turn-on bias is drawn, not given, so that the model's bias is not in here (the same file, Load).",
};
constexpr std::string_view rotors_facts[] = {
    "Densities, two-sided, of a sample each simulation step; the bias is a Gauss-Markov process that begins "
    "at "
    "zero and is driven by gyroscopeRandomWalk (rotors_simulator, "
    "rotors_gazebo_plugins/src/gazebo_imu_plugin.cpp, 748268f9a11f).",
    "The turn-on bias is drawn, not given, so that the model's bias is not in here (the same file). The "
    "macros "
    "of rotors_description call the same values gyroscope_noise_density, gyroscope_random_walk, "
    "gyroscope_bias_correlation_time and gyroscope_turn_on_bias_sigma.",
};

// The plugins assert that the correlation time is above zero.
double correlation_s(const NoiseProjection& noise) {
    return noise.gauss_markov.sigma_rad_per_s > 0.0 ? noise.gauss_markov.correlation_s : 1000.0;
}

constexpr SimulatorAbilities plugin_abilities = {
    .noise = ProjectedTerms::white_gauss_markov, .per_axis = false, .bias = false};

constexpr std::string_view plugin_endings[] = {".sdf",  ".world", ".xml",   ".model",
                                               ".urdf", ".xacro", ".gazebo"};

constexpr const char* density_name = "gyroscopeNoiseDensity";
constexpr const char* walk_name = "gyroscopeRandomWalk";
constexpr const char* correlation_name = "gyroscopeBiasCorrelationTime";

// What both plugins take for an element that is not there: twice an ADIS16448's.
constexpr double default_density_rad_per_sqrt_s = 2.0 * 35.0 / s_per_h * rad_per_deg;
constexpr double default_walk_rad_per_s_sqrt_s = 2.0 * 4.0 / s_per_h * rad_per_deg;
constexpr double default_correlation_s = 1000.0;

bool is_imu_plugin(const pugi::xml_node& element) {
    if (std::string_view(element.name()) != "plugin") { return false; }
    return element.child(density_name) || element.child(walk_name) || element.child(correlation_name) ||
           std::string_view(element.attribute("filename").value()).find("gazebo_imu_plugin") !=
               std::string_view::npos;
}

bool is_of_rotors(const pugi::xml_node& plugin) {
    return std::string_view(plugin.attribute("filename").value()).find("rotors") != std::string_view::npos;
}

bool is_rotors_plugin(const pugi::xml_node& element) {
    return is_imu_plugin(element) && is_of_rotors(element);
}
bool is_px4_plugin(const pugi::xml_node& element) { return is_imu_plugin(element) && !is_of_rotors(element); }

Result<ModelFile> read_plugin(const pugi::xml_node& plugin) {
    using Range = StatedNumbersAsText::Range;
    StatedNumbersAsText values;
    ModelFile file = nothing_stated();
    std::vector<std::string> defaults;
    const auto number = [&](const char* name, Range range, double otherwise) {
        const pugi::xml_node there = plugin.child(name);
        if (!there) { defaults.push_back(fmt::format("{} ({:.4g})", name, otherwise)); }
        return there ? values.number(text_in(there), name, range) : otherwise;
    };
    const double density = number(density_name, Range::not_negative, default_density_rad_per_sqrt_s);
    const double walk = number(walk_name, Range::not_negative, default_walk_rad_per_s_sqrt_s);
    const double correlation = number(correlation_name, Range::positive, default_correlation_s);
    const pugi::xml_node turn_on = plugin.child("gyroscopeTurnOnBiasSigma");
    const double turn_on_rad_s =
        turn_on ? values.number(text_in(turn_on), turn_on.name(), Range::not_negative) : 0.0;
    if (values.problem()) { return malformed(*values.problem()); }
    for (AxisModel& axis : file.model.axes) { axis.noise.N_rad_per_sqrt_s = density; }
    std::array<GaussMarkov, 3> slow;
    slow.fill(driven_gauss_markov(walk, correlation));
    add_gauss_markov(file.model, slow);
    if (!defaults.empty()) {
        file.notes.push_back(
            fmt::format("the file does not state {}: taken as the plugin does", fmt::join(defaults, ", ")));
    }
    if (turn_on_rad_s > 0.0) {
        file.notes.emplace_back(
            "gyroscopeTurnOnBiasSigma is left out: the simulator draws a bias from it in each "
            "run");
    }
    if (plugin.child("accelerometerNoiseDensity")) {
        file.notes.emplace_back("the accelerometer's elements are left out: only the gyro is read");
    }
    return file;
}

void change_plugin(pugi::xml_node plugin, const SimulatorSource& source) {
    const NoiseProjection& noise = source.noise[0];
    set_number(plugin, density_name, noise.N_rad_per_sqrt_s);
    set_number(plugin, walk_name, noise.drive_rad_per_s_sqrt_s());
    set_number(plugin, correlation_name, correlation_s(noise));
}

std::string plugin_text(const XmlSensorKind& kind, const SimulatorSource& source,
                        std::span<const std::string> head, const char* name, const char* library) {
    const std::string skeleton = fmt::format(
        "<?xml version=\"1.0\"?>\n<plugin name=\"{}\" filename=\"{}\">\n"
        "  <robotNamespace></robotNamespace>\n  <linkName>imu_link</linkName>\n"
        "  <imuTopic>/imu</imuTopic>\n"
        "  <gyroscopeTurnOnBiasSigma>0</gyroscopeTurnOnBiasSigma>\n</plugin>\n",
        name, library);
    return xml_made(kind, skeleton, source, head);
}

std::string px4_text(const SimulatorSource& source, std::span<const std::string> head) {
    return plugin_text(px4_plugin, source, head, "imu_plugin", "libgazebo_imu_plugin.so");
}
std::string rotors_text(const SimulatorSource& source, std::span<const std::string> head) {
    return plugin_text(rotors_plugin, source, head, "rotors_gazebo_imu_plugin",
                       "librotors_gazebo_imu_plugin.so");
}

}  // namespace

constinit const XmlSensorKind px4_plugin = {
    .kind = {.called = "an imu plugin as PX4's", .endings = plugin_endings, .abilities = plugin_abilities},
    .is = is_px4_plugin,
    .read = read_plugin,
    .change = change_plugin,
};

constinit const XmlSensorKind rotors_plugin = {
    .kind = {.called = "RotorS' imu plugin", .endings = plugin_endings, .abilities = plugin_abilities},
    .is = is_rotors_plugin,
    .read = read_plugin,
    .change = change_plugin,
};

constinit const SimulatorFormat px4_classic_format = {
    .name = "px4-classic",
    .summary = "Gazebo classic with PX4: the imu plugin's element",
    .abilities = plugin_abilities,
    .facts = px4_facts,
    .text = px4_text,
};

constinit const SimulatorFormat rotors_format = {
    .name = "rotors",
    .summary = "RotorS: the imu plugin's element",
    .abilities = plugin_abilities,
    .facts = rotors_facts,
    .text = rotors_text,
};

}  // namespace gyrolog
