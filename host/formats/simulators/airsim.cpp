#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/base/printable.hpp"
#include "host/formats/json.hpp"
#include "host/formats/json_keys.hpp"
#include "host/formats/simulators/imported_model.hpp"
#include "host/formats/simulators/simulator_texts.hpp"
#include "host/formats/simulators/simulators.hpp"

namespace gyrolog {
namespace {

// The walk is GyroBiasStability / sqrt(tau), and nothing else is made of tau: any would do.
constexpr double written_tau_s = 100.0;

constexpr std::string_view airsim_facts[] = {
    "deg/sqrt(h) and deg/h; the bias is a random walk of density GyroBiasStability / "
    "sqrt(GyroBiasStabilityTau), "
    "no Gauss-Markov process (AirSim, AirLib/include/sensors/imu/ImuSimple.hpp, 04c4bf969f6b, and "
    "ImuSimpleParams.hpp, 006d4e2ac54f).",
    "Read more often than 1000 times a second, white noise is too small and the walk too large: no step "
    "counts "
    "as shorter than 1 ms (the same, min_sample_time). The constant bias cannot be set there.",
};

constexpr SimulatorAbilities airsim_abilities = {
    .noise = ProjectedTerms::white_walk, .per_axis = false, .bias = false};
constexpr std::string_view settings_endings[] = {".json"};
constexpr SimulatorFileKind settings_kind = {"an Imu of AirSim's settings", settings_endings,
                                             airsim_abilities};

constexpr int imu_sensor_type = 2;  // AirSim, docs/sensors.md
constexpr const char* arw_key = "AngularRandomWalk";
constexpr const char* tau_key = "GyroBiasStabilityTau";
constexpr const char* stability_key = "GyroBiasStability";

constexpr double rad_s_per_deg_h = rad_per_deg / s_per_h;
const double arw_unit = rad_per_deg / std::sqrt(s_per_h);  // deg/sqrt(h)

// What AirSim takes for a key that is not there (ImuSimpleParams.hpp).
struct AirsimDefault {
    const char* key;
    double value;
};
constexpr AirsimDefault default_arw = {arw_key, 0.30};
constexpr AirsimDefault default_tau = {tau_key, 500.0};
constexpr AirsimDefault default_stability = {stability_key, 4.6};

class ImuSettings {
public:
    explicit ImuSettings(const Json& imu) : keys_(imu, "", problem_) {}

    Result<ModelFile> model() {
        ModelFile file = nothing_stated();
        const double N = number(default_arw, JsonKeys::Range::not_negative) * arw_unit;
        const double tau_s = number(default_tau, JsonKeys::Range::positive);
        const double K =
            number(default_stability, JsonKeys::Range::not_negative) * rad_s_per_deg_h / std::sqrt(tau_s);
        if (problem_) { return malformed(*problem_); }
        for (AxisModel& axis : file.model.axes) {
            axis.noise.N_rad_per_sqrt_s = N;
            axis.noise.K_rad_per_s_sqrt_s = K;
        }
        if (!defaults_.empty()) {
            file.notes.push_back(
                fmt::format("the file does not state {}: taken as AirSim does", fmt::join(defaults_, ", ")));
        }
        const Json* noisy = keys_.find("GenerateNoise");
        if (noisy != nullptr && *noisy == false) {
            file.notes.emplace_back(
                "GenerateNoise is false, which AirSim does not know and Cosys-AirSim obeys: the "
                "numbers are read nevertheless");
        }
        if (keys_.find("VelocityRandomWalk") != nullptr || keys_.find("AccelBiasStability") != nullptr) {
            file.notes.emplace_back("the accelerometer's keys are left out: only the gyro is read");
        }
        return file;
    }

private:
    double number(const AirsimDefault& otherwise, JsonKeys::Range range) {
        if (keys_.find(otherwise.key) == nullptr) {
            defaults_.push_back(fmt::format("{} ({})", otherwise.key, otherwise.value));
        }
        return keys_.number_or(otherwise.key, range, otherwise.value);
    }

    std::optional<std::string> problem_;
    JsonKeys keys_;
    std::vector<std::string> defaults_;
};

void change_imu(Json& imu, const SimulatorSource& source) {
    const NoiseProjection& noise = source.noise[0];
    const auto tau = imu.find(tau_key);
    const double kept_tau_s =
        tau != imu.end() && tau->is_number() && tau->get<double>() > 0.0 ? tau->get<double>() : written_tau_s;
    imu["GenerateNoise"] = true;
    imu[arw_key] = noise.N_rad_per_sqrt_s / arw_unit;
    imu[tau_key] = kept_tau_s;
    imu[stability_key] = noise.K_rad_per_s_sqrt_s * std::sqrt(kept_tau_s) / rad_s_per_deg_h;
}

void put_head_key(Json& settings, std::span<const std::string> head) {
    Json with_head = Json::object();
    with_head["_gyrolog"] = std::vector<std::string>(head.begin(), head.end());
    for (const auto& item : settings.items()) {
        if (item.key() != "_gyrolog") { with_head[item.key()] = item.value(); }
    }
    settings = std::move(with_head);
}

// Where a sensor stands.
using SettingsPath = std::vector<std::string>;

Json& at(Json& settings, const SettingsPath& path) {
    Json* place = &settings;
    for (const std::string& key : path) { place = &(*place)[key]; }
    return *place;
}

void find_imus(const Json& sensors, const SettingsPath& where, std::vector<SettingsPath>& found) {
    if (!sensors.is_object()) { return; }
    for (const auto& item : sensors.items()) {
        if (!item.value().is_object() || item.value().value("SensorType", Json()) != imu_sensor_type) {
            continue;
        }
        found.push_back(where);
        found.back().push_back(item.key());
    }
}

std::vector<SettingsPath> imus_in(const Json& settings) {
    std::vector<SettingsPath> found;
    if (const auto sensors = settings.find("DefaultSensors"); sensors != settings.end()) {
        find_imus(*sensors, {"DefaultSensors"}, found);
    }
    const auto vehicles = settings.find("Vehicles");
    if (vehicles == settings.end() || !vehicles->is_object()) { return found; }
    for (const auto& vehicle : vehicles->items()) {
        if (!vehicle.value().is_object()) { continue; }
        const auto sensors = vehicle.value().find("Sensors");
        if (sensors == vehicle.value().end()) { continue; }
        find_imus(*sensors, {"Vehicles", vehicle.key(), "Sensors"}, found);
    }
    return found;
}

class AirsimSettings final : public SimulatorFile {
public:
    AirsimSettings(Json settings, std::string_view text, std::vector<SettingsPath> imus)
        : settings_(std::move(settings)), imus_(std::move(imus)) {
        for (const SettingsPath& path : imus_) {
            const std::string& owner = path.size() > 2 ? path[1] : path[0];
            names_.push_back(printable(owner) + "::" + printable(path.back()));
        }
        const std::size_t line_end = text.find('\n');
        if (line_end == std::string_view::npos) { return; }
        const std::size_t from = text.find_first_not_of("\r\n \t", line_end);
        const std::size_t blanks = from == std::string_view::npos ? 0 : from - text.rfind('\n', from) - 1;
        if (blanks > 0) { indent_ = {static_cast<int>(std::min<std::size_t>(blanks, 8)), text[from - 1]}; }
    }

    const std::vector<std::string>& sensors() const override { return names_; }
    const SimulatorFileKind& kind(std::size_t /*sensor*/) const override { return settings_kind; }
    Result<ModelFile> model(std::size_t sensor) const override {
        Json settings = settings_;
        return ImuSettings(at(settings, imus_.at(sensor))).model();
    }
    Result<std::string> changed(std::size_t sensor, const SimulatorSource& source,
                                std::span<const std::string> head) const override {
        Json settings = settings_;
        change_imu(at(settings, imus_.at(sensor)), source);
        put_head_key(settings, head);
        return settings.dump(indent_.width, indent_.character, false, Json::error_handler_t::replace) + '\n';
    }

private:
    struct Indent {
        int width = 2;
        char character = ' ';
    };

    Json settings_;
    std::vector<SettingsPath> imus_;
    std::vector<std::string> names_;
    Indent indent_;
};

bool is_settings(const Json& document) {
    return !document.contains("schema") &&
           (document.contains("SettingsVersion") || document.contains("Vehicles") ||
            document.contains("DefaultSensors"));
}

// Null for JSON of another kind.
Result<std::unique_ptr<SimulatorFile>> open_settings(std::string_view text) {
    auto document = parse_json_object(text, "");
    if (!document.ok() || !is_settings(document->json)) { return std::unique_ptr<SimulatorFile>(); }
    std::vector<SettingsPath> imus = imus_in(document->json);
    if (imus.empty()) {
        return malformed(
            "AirSim's settings without an imu sensor: state one with \"SensorType\": 2 in "
            "DefaultSensors or in a vehicle's Sensors");
    }
    return std::unique_ptr<SimulatorFile>(
        std::make_unique<AirsimSettings>(std::move(document->json), text, std::move(imus)));
}

bool begins_as_json(std::string_view text) { return without_leading_blanks(text).starts_with('{'); }

std::string airsim_text(const SimulatorSource& source, std::span<const std::string> head) {
    Json settings;
    settings["SettingsVersion"] = 1.2;
    Json& imu = settings["DefaultSensors"]["Imu"];
    imu["SensorType"] = imu_sensor_type;
    imu["Enabled"] = true;
    change_imu(imu, source);
    put_head_key(settings, head);
    return written_out(settings, 2);
}

}  // namespace

constinit const SimulatorText airsim_settings_text = {begins_as_json, open_settings};

constinit const SimulatorFormat airsim_format = {
    .name = "airsim",
    .summary = "AirSim and Colosseum: settings.json",
    .abilities = airsim_abilities,
    .facts = airsim_facts,
    .text = airsim_text,
};

}  // namespace gyrolog
