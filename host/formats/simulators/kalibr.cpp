// Kalibr's imu.yaml, and the imu chain that a calibration writes ("imu0:" with the same keys below it).
// Continuous-time densities: noise density is N, random walk is K (Kalibr's wiki, "IMU Noise Model").
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <yaml-cpp/yaml.h>

#include "host/base/printable.hpp"
#include "host/formats/input_limits.hpp"
#include "host/formats/simulators/imported_model.hpp"
#include "host/formats/simulators/simulator_format.hpp"
#include "host/formats/simulators/simulator_texts.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view kalibr_endings[] = {".yaml", ".yml"};
constexpr SimulatorFileKind kalibr_kind = {
    "Kalibr's imu.yaml",
    kalibr_endings,
    {.noise = ProjectedTerms::white_walk, .projects = false, .per_axis = false, .bias = false}};

constexpr const char* density_key = "gyroscope_noise_density";
constexpr const char* walk_key = "gyroscope_random_walk";

// Whether a line states the key.
bool states(std::string_view line, std::string_view key) {
    const std::size_t from = line.find_first_not_of(" \t");
    if (from == std::string_view::npos || !line.substr(from).starts_with(key)) { return false; }
    const std::size_t colon = line.find_first_not_of(" \t", from + key.size());
    return colon != std::string_view::npos && line[colon] == ':';
}

bool begins_as_kalibr(std::string_view text) {
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        if (states(line, density_key) || states(line, walk_key)) { return true; }
        text.remove_prefix(std::min(line.size() + 1, text.size()));
    }
    return false;
}

// Brackets within brackets, at most: the library descends into them.
bool nests_too_deep(std::string_view text) {
    int depth = 0;
    return std::ranges::any_of(text, [&](char c) {
        depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
        return depth > input_limits.yaml_nesting_most;
    });
}

// The text of a key, where it is one.
std::optional<std::string> stated(const YAML::Node& imu, const char* key) {
    const YAML::Node value = imu[key];
    if (!value.IsDefined() || value.IsNull()) { return std::nullopt; }
    return value.IsScalar() ? value.Scalar() : "a list or a map";
}

Result<ModelFile> model_of(const YAML::Node& imu) {
    using Range = StatedNumbersAsText::Range;
    StatedNumbersAsText values;
    ModelFile file = nothing_stated();
    std::vector<std::string> absent;
    const auto number = [&](const char* key) {
        const auto text = stated(imu, key);
        if (!text) { absent.emplace_back(key); }
        return text ? values.number(*text, key, Range::not_negative) : 0.0;
    };
    const double N = number(density_key);
    const double K = number(walk_key);
    if (const auto rate = stated(imu, "update_rate")) {
        state_rate(file, values.number(*rate, "update_rate", Range::positive));
        file.unstated.rate = false;
    }
    if (!absent.empty()) {
        file.notes.push_back(fmt::format("the file does not state {}: taken as 0", fmt::join(absent, ", ")));
    }
    for (AxisModel& axis : file.model.axes) {
        axis.noise.N_rad_per_sqrt_s = N;
        axis.noise.K_rad_per_s_sqrt_s = K;
    }
    if (stated(imu, "accelerometer_noise_density") && stated(imu, "accelerometer_random_walk")) {
        for (AxisModel& axis : file.model.accelerometer.emplace().axes) {
            axis.noise.N_rad_per_sqrt_s = number("accelerometer_noise_density");
            axis.noise.K_rad_per_s_sqrt_s = number("accelerometer_random_walk");
        }
    }
    if (values.problem()) { return malformed(*values.problem()); }
    return file;
}

// The text in lines, each with its end.
std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        lines.emplace_back(text.substr(0, end == std::string_view::npos ? end : end + 1));
        text.remove_prefix(lines.back().size());
    }
    return lines;
}

// Puts a number where a plain one stood, right behind its own key: a line may have several, and an alias is
// marked where its anchor is. The marks count from 0.
bool replace_number(std::vector<std::string>& lines, std::string_view key, const YAML::Node& value,
                    const std::string& number) {
    const auto line = static_cast<std::size_t>(std::max(0, value.Mark().line));
    const std::string& old = value.Scalar();
    if (line >= lines.size() || old.empty()) { return false; }
    const std::size_t from =
        std::min(static_cast<std::size_t>(std::max(0, value.Mark().column)), lines[line].size());
    std::string before = lines[line].substr(0, from);
    before.erase(before.find_last_not_of(" \t") + 1);
    if (!before.ends_with(std::string(key) + ":") || lines[line].compare(from, old.size(), old) != 0) {
        return false;
    }
    lines[line].replace(from, old.size(), number);
    return true;
}

// Puts a line of its own behind that of another key.
bool add_number(std::vector<std::string>& lines, const YAML::Node& neighbour, const char* key,
                const std::string& number) {
    if (!neighbour.IsDefined() || !neighbour.IsScalar()) { return false; }
    const auto line = static_cast<std::size_t>(std::max(0, neighbour.Mark().line));
    if (line >= lines.size()) { return false; }
    const std::string indent = lines[line].substr(0, lines[line].find_first_not_of(" \t"));
    if (!lines[line].ends_with('\n')) { lines[line] += '\n'; }
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(line) + 1, indent + key + ": " + number + '\n');
    return true;
}

void remove_own_head(std::vector<std::string>& lines) {
    if (lines.empty() || !lines.front().starts_with('#') || !is_own_head(lines.front())) { return; }
    const auto is_rest = [](const std::string& line) { return !line.starts_with('#'); };
    lines.erase(lines.begin(), std::ranges::find_if(lines, is_rest));
    if (!lines.empty() && lines.front().find_first_not_of(" \t\r\n") == std::string::npos) {
        lines.erase(lines.begin());
    }
}

class KalibrImu final : public SimulatorFile {
public:
    KalibrImu(std::string_view text, std::vector<std::pair<std::string, YAML::Node>> imus)
        : text_(text), imus_(std::move(imus)) {
        for (const auto& imu : imus_) { names_.push_back(printable(imu.first)); }
    }

    const std::vector<std::string>& sensors() const override { return names_; }
    const SimulatorFileKind& kind(std::size_t /*sensor*/) const override { return kalibr_kind; }
    Result<ModelFile> model(std::size_t sensor) const override { return model_of(imus_.at(sensor).second); }
    Result<std::string> changed(std::size_t sensor, const SimulatorSource& source,
                                std::span<const std::string> head) const override {
        const YAML::Node& imu = imus_.at(sensor).second;
        std::vector<std::string> lines = lines_of(text_);
        std::vector<std::string> comments(head.begin(), head.end());
        const NoiseProjection& noise = source.noise[0];
        const std::array numbers = {std::pair(walk_key, noise.K_rad_per_s_sqrt_s),
                                    std::pair(density_key, noise.N_rad_per_sqrt_s)};
        bool done = true;
        for (const auto& [key, value] : numbers) {
            if (value == 0.0) {
                comments.push_back(
                    fmt::format("{}: the model has none, and Kalibr wants one: as it was.", key));
                continue;
            }
            const YAML::Node there = imu[key];
            const std::string number = fmt::format("{:.9g}", value);
            const char* neighbour = key == walk_key ? density_key : walk_key;
            done = done &&
                   (there.IsDefined() && there.IsScalar() ? replace_number(lines, key, there, number)
                                                          : add_number(lines, imu[neighbour], key, number));
        }
        if (!done) {
            return Error{ErrorCode::unsupported,
                         "its numbers are not written one in a line, as \"key: number\""};
        }
        remove_own_head(lines);
        return commented(comments, "#") + '\n' + fmt::format("{}", fmt::join(lines, ""));
    }

private:
    std::string text_;
    std::vector<std::pair<std::string, YAML::Node>> imus_;
    std::vector<std::string> names_;
};

bool is_imu(const YAML::Node& node) {
    return node.IsMap() && (node[density_key].IsDefined() || node[walk_key].IsDefined());
}

Result<std::unique_ptr<SimulatorFile>> open_parsed(std::string_view text) {
    const YAML::Node document = YAML::Load(std::string(text));
    std::vector<std::pair<std::string, YAML::Node>> imus;
    if (is_imu(document)) {
        imus.emplace_back("", document);
    } else if (document.IsMap()) {
        for (const auto& item : document) {
            if (item.first.IsScalar() && is_imu(item.second)) {
                imus.emplace_back(item.first.Scalar(), item.second);
            }
        }
    }
    if (imus.empty()) {
        return malformed(fmt::format(
            "no imu of Kalibr is in it: {} stands neither at the top nor one map below", density_key));
    }
    return std::unique_ptr<SimulatorFile>(std::make_unique<KalibrImu>(text, std::move(imus)));
}

Result<std::unique_ptr<SimulatorFile>> open_kalibr(std::string_view text) {
    if (text.size() > input_limits.yaml_bytes_most) {
        return malformed(fmt::format("longer than {} bytes: no imu.yaml", input_limits.yaml_bytes_most));
    }
    if (nests_too_deep(text)) {
        return malformed(fmt::format("nested deeper than {} lists and maps", input_limits.yaml_nesting_most));
    }
    try {
        return open_parsed(text);
    } catch (const YAML::Exception& refusal) {
        return malformed(fmt::format("no YAML: line {}: {}", refusal.mark.line + 1, printable(refusal.msg)));
    }
}

}  // namespace

constinit const SimulatorText kalibr_imu_text = {begins_as_kalibr, open_kalibr};

}  // namespace gyrolog
