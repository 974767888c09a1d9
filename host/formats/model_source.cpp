#include "host/formats/model_source.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/base/printable.hpp"
#include "host/formats/text_file.hpp"

namespace gyrolog {
namespace {

bool exists(const std::string& path) {
    std::error_code none;
    return std::filesystem::exists(path, none);
}

// The whole name, or the end of it from one of its parts on.
bool is_called(std::string_view name, std::string_view wanted) {
    return name == wanted ||
           (name.ends_with(wanted) && name.substr(0, name.size() - wanted.size()).ends_with("::"));
}

std::string list_of(const std::vector<std::string>& names) {
    constexpr std::size_t listed_most = 20;
    const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), listed_most));
    std::vector<std::string> quoted;
    std::transform(names.begin(), end, std::back_inserter(quoted), [](const std::string& name) {
        return name.empty() ? std::string("one without a name") : "'" + name + "'";
    });
    return fmt::format("{}{}", fmt::join(quoted, ", "), names.size() > listed_most ? ", ..." : "");
}

Result<std::size_t> chosen_sensor(const std::vector<std::string>& names, const ModelPath& path) {
    if (path.sensor.empty()) {
        if (names.size() == 1) { return std::size_t{0}; }
        return invalid_argument(
            fmt::format("model '{0}': {1} sensors are in it: {2}; name one behind the path: "
                        "'{0}#{3}'",
                        path.file, names.size(), list_of(names), names.back()));
    }
    std::vector<std::size_t> called;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == path.sensor) { return i; }
        if (is_called(names[i], path.sensor)) { called.push_back(i); }
    }
    if (called.size() == 1) { return called.front(); }
    return invalid_argument(fmt::format("model '{}': {} called '{}'; there {} {}", path.file,
                                        called.empty() ? "no sensor is" : "several sensors are",
                                        printable(path.sensor), names.size() == 1 ? "is" : "are",
                                        list_of(names)));
}

std::string shown_name(const std::string& file, const std::string& sensor) {
    const std::string name = std::filesystem::path(file).filename().string();
    return sensor.empty() ? name : name + "#" + sensor;
}

bool is_silent(const ModelFile& file) {
    const auto has_noise = [](const AxisModel& axis) {
        return axis.noise.N_rad_per_sqrt_s > 0.0 || axis.noise.K_rad_per_s_sqrt_s > 0.0;
    };
    return file.model.effects.empty() && std::ranges::none_of(file.model.axes, has_noise) &&
           std::ranges::none_of(file.unrated_sd_rad_s, [](double sd) { return sd > 0.0; });
}

// White noise of the axis where it is largest: what every kind states.
template <typename NoiseOf>
double largest_N(NoiseOf noise_of) {
    return std::max({noise_of(0), noise_of(1), noise_of(2)});
}

// Whether what was written is read again.
bool holds(const SimulatorFile& file, std::size_t sensor, const SimulatorSource& written) {
    auto read = file.model(sensor);
    if (!read.ok()) { return false; }
    if (read->unstated.rate) { state_rate(*read, written.rate_hz); }
    const double wanted =
        largest_N([&](std::size_t axis) { return written.noise.at(axis).N_rad_per_sqrt_s; });
    const double found =
        largest_N([&](std::size_t axis) { return read->model.axes.at(axis).noise.N_rad_per_sqrt_s; });
    constexpr double printed_rel = 1e-6;
    return wanted == 0.0 || std::fabs(found - wanted) <= printed_rel * wanted;
}

// The head but for its first line, a line that goes on with the one that it goes on in.
std::vector<std::string> told_of(std::span<const std::string> head) {
    std::vector<std::string> told;
    for (const std::string& line : head.subspan(1)) {
        if (!told.empty() && told.back().ends_with(':')) {
            told.back() += " " + line;
        } else {
            told.push_back(line);
        }
    }
    return told;
}

}  // namespace

ModelPath model_path(const std::string& text) {
    if (exists(text)) { return {text, ""}; }
    for (std::size_t at = text.find('#'); at != std::string::npos; at = text.find('#', at + 1)) {
        if (at > 0 && exists(text.substr(0, at))) { return {text.substr(0, at), text.substr(at + 1)}; }
    }
    return {text, ""};
}

bool is_model_file(const std::string& path) {
    const ModelPath place = model_path(path);
    if (place.file.ends_with(".json") || !place.sensor.empty()) { return true; }
    std::error_code none;
    if (!std::filesystem::is_regular_file(place.file, none)) { return false; }
    auto reader = TextReader::open(place.file);
    if (!reader.ok()) { return false; }
    const auto beginning = reader->read();
    return beginning.ok() && begins_as_simulator_file(*beginning);
}

Result<ModelSource> read_model_source(const std::string& path, std::uint64_t seed) {
    const ModelPath place = model_path(path);
    GYROLOG_TRY(const std::string text, read_model_text(place.file));
    return parse_model_source(text, place, seed);
}

Result<ModelSource> parse_model_source(const std::string& text, const ModelPath& path, std::uint64_t seed) {
    const auto context = [&] { return "model '" + path.file + "'"; };
    auto opened = open_simulator_file(text);
    if (!opened.ok()) { return in_context(context(), opened.error()); }
    if (*opened == nullptr) {
        if (!path.sensor.empty()) {
            return invalid_argument(context() + ": it is one sensor; '#" + printable(path.sensor) +
                                    "' names none");
        }
        GYROLOG_TRY(ModelFile file, parse_model_file(text, path.file, seed));
        return ModelSource{std::move(file), path.file, shown_name(path.file, "")};
    }
    std::shared_ptr<const SimulatorFile> simulator = std::move(*opened);
    const std::vector<std::string>& names = simulator->sensors();
    GYROLOG_TRY(const std::size_t sensor, chosen_sensor(names, path));
    const std::string called = names[sensor].empty() ? "" : " '" + names[sensor] + "'";
    auto file = simulator->model(sensor);
    if (!file.ok()) {
        return in_context(context() + (called.empty() ? "" : ", sensor" + called), file.error());
    }
    if (!can_be_written(*file)) {
        return malformed(context() + ": holds a number too large or too small to work with");
    }
    file->notes.insert(file->notes.begin(),
                       fmt::format("the model is taken from {}{}", simulator->kind(sensor).called, called));
    if (is_silent(*file)) { file->notes.emplace_back("the file states no noise of the gyro"); }
    return ModelSource{*std::move(file), path.file,
                       shown_name(path.file, names.size() == 1 ? "" : names[sensor]), std::move(simulator),
                       sensor};
}

Result<ChangedFile> changed_simulator_file(const ModelSource& source, const SensorModel& model,
                                           const std::string& from, double horizon_s) {
    if (!(model.rate_hz > 0.0)) { return invalid_argument("the model's rate is not known"); }
    const SimulatorAbilities& abilities = source.simulator->kind(source.sensor).abilities;
    const SimulatorSource numbers = simulator_source(model, from, abilities, horizon_s);
    std::vector<std::string> head = head_lines(numbers, abilities);
    GYROLOG_TRY(std::string text, source.simulator->changed(source.sensor, numbers, head));
    const auto again = open_simulator_file(text);
    if (!again.ok() || *again == nullptr ||
        (*again)->sensors().size() != source.simulator->sensors().size() ||
        !holds(**again, source.sensor, numbers)) {
        return Error{ErrorCode::unsupported, "its numbers stand where they cannot be changed"};
    }
    return ChangedFile{std::move(text), told_of(head)};
}

}  // namespace gyrolog
