#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/formats/simulators/imported_model.hpp"
#include "host/formats/simulators/simulators.hpp"
#include "host/formats/simulators/three_numbers.hpp"
#include "host/formats/simulators/xml_edit.hpp"
#include "host/formats/simulators/xml_sensor.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view mjcf_facts[] = {
    "MuJoCo from 3.1.4 on adds no noise: noise is a note there. The lines in Python below add it, and the "
    "bias, to "
    "what the sensor reads; the error above is theirs (MuJoCo, changelog of 3.1.4, item 1; XML reference, "
    "sensor).",
    "Before 3.1.4 it adds noise where <flag sensornoise=\"enable\"/> stands in the option element, of one "
    "size for all axes: here that of the noisiest (MuJoCo, src/engine/engine_sensor.c, add_noise, "
    "01a932e052f5).",
    "From 3.5 on a body may have shorter steps than the sensor: take the gyro in the comment below, which is "
    "read every interval and shown with delay. nsample belongs to both: without it interval is not heeded, "
    "and with fewer the delay is shorter (seen in 3.14.0).",
    "cutoff is the range. Or put libgyrolog-sensor into the loop, which has the whole model.",
};

double noisiest_rad_s(const SimulatorSource& source) {
    double sd_rad_s = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sd_rad_s = std::max(sd_rad_s, source.sample_sd_rad_s(axis));
    }
    return sd_rad_s;
}

std::string range_text(const SimulatorSource& source) {
    return source.full_scale_rad_s > 0.0 ? fmt::format(" cutoff=\"{:.9g}\"", source.full_scale_rad_s) : "";
}

// For versions that have delay and interval. What is kept reaches back to the reading that is shown.
std::string late_gyro_text(const SimulatorSource& source) {
    const double periods = std::ceil(source.latency_s * source.rate_hz);
    return fmt::format(
        "    <gyro name=\"gyro\" site=\"imu\" noise=\"{:.9g}\"{} interval=\"{:.9g}\" delay=\"{:.9g}\" "
        "nsample=\"{:.0f}\"/>\n",
        noisiest_rad_s(source), range_text(source), 1.0 / source.rate_hz, source.latency_s, periods + 1.0);
}

std::string python_text(const SimulatorSource& source) {
    Vector3 sd_rad_s{};
    Vector3 keep{};
    Vector3 drive_rad_s{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const GaussMarkov& slow = source.noise[axis].gauss_markov;
        sd_rad_s[axis] = source.sample_sd_rad_s(axis);
        if (slow.sigma_rad_per_s == 0.0) { continue; }
        const double steps = 1.0 / (slow.correlation_s * source.rate_hz);
        keep[axis] = std::exp(-steps);
        drive_rad_s[axis] = slow.sigma_rad_per_s * std::sqrt(-std::expm1(-2.0 * steps));
    }
    return fmt::format(
        "\n  import numpy as np\n  random = np.random.default_rng(1)\n  drift = np.zeros(3)\n"
        "  def gyro(data):  # once a sample, {:.9g} times a second\n      global drift\n"
        "      drift = np.array([{}]) * drift + np.array([{}]) * random.standard_normal(3)\n"
        "      return (data.sensor('gyro').data + np.array([{}]) + drift\n"
        "              + np.array([{}]) * random.standard_normal(3))\n",
        source.rate_hz, three_numbers(keep), three_numbers(drive_rad_s), three_numbers(source.bias_rad_s),
        three_numbers(sd_rad_s));
}

constexpr SimulatorAbilities mjcf_abilities = {.noise = ProjectedTerms::white_gauss_markov, .clips = true};
constexpr std::string_view mjcf_endings[] = {".xml", ".mjcf"};

constexpr double default_timestep_s = 0.002;  // MuJoCo, XML reference, option

bool is_mjcf_gyro(const pugi::xml_node& element) {
    return std::string_view(element.name()) == "gyro" &&
           std::string_view(element.parent().name()) == "sensor";
}

// The first of the numbers in an attribute; "interval" has a phase as well.
std::string first_number(const pugi::xml_attribute& attribute) {
    const std::string_view text = attribute.value();
    const std::size_t from = text.find_first_not_of(" \t\r\n");
    if (from == std::string_view::npos) { return ""; }
    const std::size_t end = text.find_first_of(" \t\r\n", from);
    return std::string(text.substr(from, end == std::string_view::npos ? end : end - from));
}

class MjcfReading {
public:
    explicit MjcfReading(const pugi::xml_node& gyro) : gyro_(gyro) {}

    Result<ModelFile> model() {
        const double rate_hz = 1.0 / sample_s();
        const double sd_rad_s = number(gyro_, "noise", Range::not_negative, 0.0);
        const double cutoff_rad_s = number(gyro_, "cutoff", Range::not_negative, 0.0);
        if (keeps_readings()) { file_.model.latency_s = number(gyro_, "delay", Range::not_negative, 0.0); }
        if (values_.problem()) { return malformed(*values_.problem()); }
        file_.unrated_sd_rad_s.fill(sd_rad_s);
        state_rate(file_, rate_hz);
        file_.unstated.rate = false;
        if (cutoff_rad_s > 0.0) { state_range(file_, cutoff_rad_s); }
        file_.notes.push_back(
            fmt::format("noise is taken for that of a sample at {:.6g} Hz, {}; MuJoCo from 3.1.4 on "
                        "adds none by itself, and lines in Python that do are not read",
                        rate_hz, source_of_rate_));
        return std::move(file_);
    }

private:
    using Range = StatedNumbersAsText::Range;

    double number(const pugi::xml_node& element, const char* name, Range range, double otherwise) {
        const pugi::xml_attribute attribute = element.attribute(name);
        return attribute ? values_.number(first_number(attribute), name, range) : otherwise;
    }

    // Without, interval and delay are not heeded: see mjcf_facts.
    bool keeps_readings() { return number(gyro_, "nsample", Range::not_negative, 0.0) > 0.0; }

    // Of the gyro, or of the simulation: the last option of several counts.
    double sample_s() {
        const double interval_s = number(gyro_, "interval", Range::not_negative, 0.0);
        if (interval_s > 0.0 && keeps_readings()) {
            source_of_rate_ = "by the gyro's interval";
            return interval_s;
        }
        double timestep_s = default_timestep_s;
        source_of_rate_ = "by MuJoCo's timestep without one stated";
        for (const pugi::xml_node& option : gyro_.parent().parent().children("option")) {
            if (!option.attribute("timestep")) { continue; }
            timestep_s = number(option, "timestep", Range::positive, timestep_s);
            source_of_rate_ = "by the timestep";
        }
        return timestep_s;
    }

    pugi::xml_node gyro_;
    ModelFile file_ = nothing_stated();
    StatedNumbersAsText values_;
    const char* source_of_rate_ = "";
};

Result<ModelFile> read_mjcf(const pugi::xml_node& gyro) { return MjcfReading(gyro).model(); }

void change_mjcf(pugi::xml_node gyro, const SimulatorSource& source) {
    set_number_attribute(gyro, "noise", noisiest_rad_s(source));
    if (source.full_scale_rad_s > 0.0) { set_number_attribute(gyro, "cutoff", source.full_scale_rad_s); }
}

std::string comment_text(const SimulatorSource& source) {
    return "\n" + late_gyro_text(source) + python_text(source);
}

std::string mjcf_text(const SimulatorSource& source, std::span<const std::string> head) {
    const std::string skeleton = fmt::format(
        "<?xml version=\"1.0\"?>\n<mujoco model=\"imu\">\n  <option timestep=\"{:.9g}\"/>\n"
        "  <worldbody>\n    <body name=\"imu\">\n      <freejoint/>\n"
        "      <geom type=\"box\" size=\".01 .01 .01\" mass=\".01\"/>\n"
        "      <site name=\"imu\"/>\n    </body>\n  </worldbody>\n  <sensor>\n"
        "    <gyro name=\"gyro\" site=\"imu\"/>\n  </sensor>\n</mujoco>\n",
        1.0 / source.rate_hz);
    return xml_made(mjcf_gyro, skeleton, source, head);
}

}  // namespace

constinit const XmlSensorKind mjcf_gyro = {
    .kind = {.called = "a gyro of MJCF", .endings = mjcf_endings, .abilities = mjcf_abilities},
    .is = is_mjcf_gyro,
    .read = read_mjcf,
    .change = change_mjcf,
    .footnote = comment_text,
};

constinit const SimulatorFormat mjcf_format = {
    .name = "mjcf",
    .summary = "MuJoCo: a gyro in MJCF, with its noise in Python",
    .abilities = mjcf_abilities,
    .facts = mjcf_facts,
    .text = mjcf_text,
};

}  // namespace gyrolog
