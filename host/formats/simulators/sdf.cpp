#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "host/base/printable.hpp"
#include "host/formats/simulators/imported_model.hpp"
#include "host/formats/simulators/simulators.hpp"
#include "host/formats/simulators/xml_edit.hpp"
#include "host/formats/simulators/xml_sensor.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view sdf_facts[] = {
    "stddev is per sample, so that update_rate belongs to it. dynamic_bias_stddev is no standard deviation "
    "but "
    "the density that drives the bias, rad/s*sqrt(Hz); the bias begins at rest "
    "(gz-sensors, src/GaussianNoiseModel.cc, ApplyImpl).",
    "The bias is in mean: bias_mean changes its sign in half of all runs, and decays with the correlation "
    "time "
    "(the same file, Load and ApplyImpl; the sign also at b394cc612d26).",
    "precision below 1e-6 rad/s is taken for none (the same file, Load).",
    "Put the sensor element into a link of a model.",
};

constexpr SimulatorAbilities abilities = {.noise = ProjectedTerms::white_gauss_markov, .rounds = true};
constexpr std::string_view endings[] = {".sdf", ".world", ".xml", ".model", ".urdf", ".xacro"};

// Below it gz-sensors takes a precision for none.
constexpr double precision_least_rad_s = 1e-6;

bool is_sdf_sensor(const pugi::xml_node& element) {
    return std::string_view(element.name()) == "sensor" &&
           std::string_view(element.attribute("type").value()) == "imu";
}

// An attribute; an element as well until SDF 1.4.
std::string type_of(const pugi::xml_node& noise) {
    const pugi::xml_attribute attribute = noise.attribute("type");
    return attribute ? attribute.value() : text_in(noise.child("type"));
}

class SdfReading {
public:
    explicit SdfReading(const pugi::xml_node& sensor) : sensor_(sensor) {}

    Result<ModelFile> model() {
        read_rate();
        const pugi::xml_node imu = sensor_.child("imu");
        const pugi::xml_node angular_velocity = imu.child("angular_velocity");
        if (!angular_velocity && imu.child("noise")) {
            values_.fail("<noise>",
                         "stands in <imu>, as it did until SDF 1.4: put it into <angular_velocity>, "
                         "for each axis");
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::string name = axis_names[axis];
            read_axis(axis, angular_velocity.child(name.c_str()).child("noise"));
        }
        if (values_.problem()) { return malformed(*values_.problem()); }
        add_gauss_markov(file_.model, slow_);
        read_steps();
        add_notes(imu);
        return std::move(file_);
    }

private:
    double number(const pugi::xml_node& parent, const char* name, const std::string& where,
                  StatedNumbersAsText::Range range) {
        const pugi::xml_node there = parent.child(name);
        return there ? values_.number(text_in(there), where + name, range) : 0.0;
    }

    void read_rate() {
        const double rate_hz = number(sensor_, "update_rate", "", Range::not_negative);
        if (rate_hz == 0.0) { return; }
        state_rate(file_, rate_hz);
        file_.unstated.rate = false;
    }

    void read_axis(std::size_t axis, const pugi::xml_node& noise) {
        if (!noise) { return; }
        const std::string type = type_of(noise);
        if (type.empty() || type == "none") { return; }
        const std::string where = std::string(axis_names[axis]) + ": ";
        if (type != "gaussian" && type != "gaussian_quantized") {
            values_.fail(where + "type", "is " + in_quotes(type) + ", which is no noise of SDF");
        }
        AxisModel& model = file_.model.axes[axis];
        model.bias_rad_s = number(noise, "mean", where, Range::any);
        file_.unrated_sd_rad_s[axis] = number(noise, "stddev", where, Range::not_negative);
        if (!file_.unstated.rate) { state_rate(file_, file_.model.rate_hz); }
        const double drive = number(noise, "dynamic_bias_stddev", where, Range::not_negative);
        const double correlation_s = number(noise, "dynamic_bias_correlation_time", where, Range::any);
        if (correlation_s > 0.0) { slow_[axis] = driven_gauss_markov(drive, correlation_s); }
        no_correlation_ = no_correlation_ || (drive > 0.0 && correlation_s <= 0.0);
        // With either type it rounds (GaussianNoiseModel.cc, Load).
        step_rad_s_[axis] = number(noise, "precision", where, Range::not_negative);
        draws_bias_ = draws_bias_ || number(noise, "bias_mean", where, Range::any) != 0.0 ||
                      number(noise, "bias_stddev", where, Range::not_negative) != 0.0;
    }

    void read_steps() {
        const auto [least, most] = std::ranges::minmax_element(step_rad_s_);
        if (*most == 0.0) { return; }
        if (*most < precision_least_rad_s) {
            file_.notes.push_back(
                fmt::format("precision {:.3g} is below 1e-6 rad/s, which gz-sensors takes for "
                            "none",
                            *most));
            return;
        }
        state_step(file_, *most);
        if (*least == *most) { return; }
        file_.notes.push_back(
            fmt::format("precision differs between the axes; a model has one step for all: the "
                        "largest, {:.6g} rad/s",
                        *most));
    }

    void add_notes(const pugi::xml_node& imu) {
        if (file_.unstated.rate &&
            std::ranges::any_of(file_.unrated_sd_rad_s, [](double sd) { return sd > 0.0; })) {
            file_.notes.emplace_back(
                "update_rate is not stated: stddev is taken for that of a sample at the "
                "recording's rate");
        }
        if (draws_bias_) {
            file_.notes.emplace_back(
                "bias_mean and bias_stddev are left out: the simulator draws a bias from "
                "them in each run");
        }
        if (no_correlation_) {
            file_.notes.emplace_back(
                "dynamic_bias_stddev is left out where dynamic_bias_correlation_time is not "
                "above zero: the simulator makes no noise of it then");
        }
        if (imu.child("linear_acceleration")) {
            file_.notes.emplace_back("linear_acceleration is left out: only the gyro is read");
        }
    }

    using Range = StatedNumbersAsText::Range;

    pugi::xml_node sensor_;
    ModelFile file_ = nothing_stated();
    StatedNumbersAsText values_;
    std::array<GaussMarkov, 3> slow_{};
    Vector3 step_rad_s_{};
    bool draws_bias_ = false;
    bool no_correlation_ = false;
};

Result<ModelFile> read_sdf(const pugi::xml_node& sensor) { return SdfReading(sensor).model(); }

void change_noise(pugi::xml_node noise, const SimulatorSource& source, std::size_t axis) {
    const bool rounds = source.lsb_rad_s >= precision_least_rad_s;
    set_attribute(noise, "type", rounds ? "gaussian_quantized" : "gaussian");
    if (noise.child("type")) { noise.remove_child("type"); }
    set_number(noise, "mean", source.bias_rad_s[axis]);
    // A bias that is known takes the place of one that is drawn, which would come on top.
    for (const char* drawn : {"bias_mean", "bias_stddev"}) {
        if (source.bias_rad_s[axis] != 0.0 && noise.child(drawn)) { set_number(noise, drawn, 0.0); }
    }
    set_number(noise, "stddev", source.sample_sd_rad_s(axis));
    const NoiseProjection& of = source.noise[axis];
    const bool has_slow = of.gauss_markov.sigma_rad_per_s > 0.0;
    if (has_slow || noise.child("dynamic_bias_stddev")) {
        set_number(noise, "dynamic_bias_stddev", of.drive_rad_per_s_sqrt_s());
    }
    if (has_slow) { set_number(noise, "dynamic_bias_correlation_time", of.gauss_markov.correlation_s); }
    if (rounds || noise.child("precision")) {
        set_number(noise, "precision", rounds ? source.lsb_rad_s : 0.0);
    }
}

void change_sdf(pugi::xml_node sensor, const SimulatorSource& source) {
    // stddev is that of a sample: a rate that is stated is the model's.
    if (finite_number(text_in(sensor.child("update_rate"))).value_or(0.0) == 0.0) {
        set_number(sensor, "update_rate", source.rate_hz);
    }
    const pugi::xml_node angular_velocity = child_made(child_made(sensor, "imu"), "angular_velocity");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        change_noise(child_made(child_made(angular_velocity, axis_names[axis]), "noise"), source, axis);
    }
}

std::string sdf_text(const SimulatorSource& source, std::span<const std::string> head) {
    return xml_made(sdf_sensor,
                    "<?xml version=\"1.0\"?>\n<sdf version=\"1.7\">\n  <model name=\"imu\">\n"
                    "    <link name=\"imu_link\">\n      <sensor name=\"imu\" type=\"imu\">\n"
                    "        <always_on>1</always_on>\n      </sensor>\n    </link>\n  </model>\n</sdf>\n",
                    source, head);
}

}  // namespace

constinit const XmlSensorKind sdf_sensor = {
    .kind = {.called = "an imu sensor of SDF", .endings = endings, .abilities = abilities},
    .is = is_sdf_sensor,
    .read = read_sdf,
    .change = change_sdf,
};

constinit const SimulatorFormat sdf_format = {
    .name = "sdf",
    .summary = "gz-sensors and Gazebo classic: an imu sensor in SDF",
    .abilities = abilities,
    .facts = sdf_facts,
    .text = sdf_text,
};

}  // namespace gyrolog
