#include "host/formats/export_format.hpp"

#include <algorithm>
#include <array>

#include "host/base/file_output.hpp"
#include "host/formats/filter_tuning_json.hpp"
#include "host/formats/filters/filters.hpp"
#include "host/formats/gyroparams_script.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/formats/recording_mat.hpp"

namespace gyrolog {
namespace {

using Needs = ExportFormat::Needs;

// Counts with the digits that their step needs; what came as text, as it came.
Status write_csv(const ExportSource& source, const std::string& path) {
    CsvWriteOptions options;
    for (const Column& column : source.recording->columns) {
        if (column.is_counts()) { options.resolved.push_back(column.name); }
    }
    return write_recording_csv(*source.recording, path, options);
}

template <std::string (*text_of)(const ExportSource&)>
Status write_text_of(const ExportSource& source, const std::string& path) {
    return write_file(path, as_bytes(text_of(source)));
}

constexpr std::array formats = {
    ExportFormat{".csv", "the samples as text", Needs::samples, Sensors::all, write_csv},
    ExportFormat{".csv.gz", "", Needs::samples, Sensors::all, write_csv},
    ExportFormat{".csv.xz", "", Needs::samples, Sensors::all, write_csv},
    ExportFormat{".csv.zst", "", Needs::samples, Sensors::all, write_csv},
    ExportFormat{".mat", "samples and analysis for MATLAB, level 5", Needs::analysis, Sensors::all,
                 write_recording_mat},
    ExportFormat{".yaml", "Kalibr's imu.yaml", Needs::noise, Sensors::all, nullptr, &kalibr_format},
    ExportFormat{".m", "a MATLAB gyroparams object", Needs::noise, Sensors::gyro,
                 write_text_of<gyroparams_script>},
    ExportFormat{".tuning.json", "process noise for Kalman filters", Needs::noise, Sensors::gyro,
                 write_text_of<filter_tuning_json>},
};

}  // namespace

std::span<const ExportFormat> export_formats() { return formats; }

const ExportFormat* export_format_of(std::string_view path) {
    const auto found =
        std::ranges::find_if(formats, [&](const ExportFormat& f) { return path.ends_with(f.ending); });
    return found == formats.end() ? nullptr : &*found;
}

Status write_export(const ExportFormat& format, const ExportSource& source, const std::string& path) {
    if (format.filter == nullptr) { return format.write(source, path); }
    return write_file(path, as_bytes(filter_text(*format.filter, source)));
}

ExportFormat export_format_of(const FilterFormat& filter) {
    return {"", filter.summary, Needs::noise, Sensors::all, nullptr, &filter};
}

}  // namespace gyrolog
