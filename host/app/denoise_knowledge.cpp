#include "host/app/denoise_knowledge.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "host/app/sensor_choice.hpp"
#include "host/formats/model_source.hpp"

namespace gyrolog {

std::vector<std::vector<double>> gyro_means(const Recording& recording) {
    std::vector<std::vector<double>> means;
    for (const ArrayAxis& axis : array_axes(recording)) {
        std::vector<double> mean(recording.rows(), 0.0);
        for (std::size_t row = 0; row < mean.size(); ++row) {
            double count = 0.0;
            for (const Column* unit : axis.units) {
                const double value = unit->value(row);
                if (!(value == value)) { continue; }
                mean[row] += value;
                count += 1.0;
            }
            mean[row] /= std::max(1.0, count);
        }
        means.push_back(std::move(mean));
    }
    return means;
}

TimeSpan still_part_of(const Recording& recording) { return still_part(recording, gyro_means(recording)); }

Result<Recording> rows_at_rest(const Recording& recording, const TimeSpan& still) {
    std::vector<const Column*> gyros;
    for (const ArrayAxis& axis : array_axes(recording)) {
        gyros.insert(gyros.end(), axis.units.begin(), axis.units.end());
    }
    const std::vector<Segment> parts =
        segments_known(gyros, segments_within(recording.segments, recording.rate_hz, still));
    Recording rows = rows_of(recording, gyros, parts);
    constexpr std::size_t rows_least = 64;
    if (rows.rows() < rows_least) {
        return Error{ErrorCode::failed,
                     fmt::format("the part at rest, {:.6g} s to {:.6g} s, has {} samples of all units; "
                                 "{} are needed: name another with --still FROM,TO",
                                 still.from_s, still.to_s, rows.rows(), rows_least)};
    }
    return rows;
}

Result<std::vector<std::string>> use_model_files(std::vector<AxisKnowledge>& knowledge,
                                                 const std::vector<std::string>& paths, double rate_hz,
                                                 SensorKind sensor) {
    std::vector<SensorModel> models;
    std::vector<std::string> notes;
    for (const std::string& path : paths) {
        GYROLOG_TRY(ModelSource source, read_model_source(path, 1));
        if (source.file.unstated.rate) { state_rate(source.file, rate_hz); }
        for (const std::string& note : source.file.notes) {
            if (source.simulator != nullptr) { notes.push_back(source.name + ": " + note); }
        }
        GYROLOG_TRY(ModelFile file, model_of_sensor(std::move(source.file), sensor, path));
        models.push_back(std::move(file.model));
    }
    std::vector<std::vector<NoiseModel>> given;
    for (const AxisKnowledge& axis : knowledge) {
        if (models.size() != 1 && models.size() != axis.units.size()) {
            return invalid_argument(
                fmt::format("{} models for {} units on axis {}: give one for all, or one for each, "
                            "in the units' order",
                            models.size(), axis.units.size(), axis.axis));
        }
        std::vector<NoiseModel> units;
        for (std::size_t i = 0; i < axis.units.size(); ++i) {
            const SensorModel& model = models[models.size() == 1 ? 0 : i];
            const auto at = static_cast<std::size_t>(axis.axis.front() - 'x');
            NoiseModel noise;
            noise.coefficients = model.axes.at(at).noise;
            noise.converter = {model.lsb_rad_s, rate_hz};
            if (!(noise.coefficients.N_rad_per_sqrt_s > 0.0)) {
                return invalid_argument("model '" + paths[models.size() == 1 ? 0 : i] +
                                        "' has no N on axis " + axis.axis + ": nothing to weigh its unit by");
            }
            units.push_back(noise);
        }
        given.push_back(std::move(units));
    }
    use_models(knowledge, given);
    return notes;
}

}  // namespace gyrolog
