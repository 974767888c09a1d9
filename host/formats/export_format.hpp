// The formats that a recording or a model can be exported to, told by the file's ending. A format is one
// file, and one line in export_format.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "analysis/noise/sensor_unit.hpp"
#include "host/base/result.hpp"
#include "host/formats/export_source.hpp"
#include "host/formats/filters/filter_format.hpp"

namespace gyrolog {

struct ExportFormat {
    std::string_view ending;
    std::string_view summary;
    enum class Needs {
        samples,   // the recording alone
        analysis,  // the recording and its analysis
        noise,     // noise coefficients, of an analysis or of a model
    };
    Needs needs;
    Sensors sensors;  // those of the analysis that it needs
    Status (*write)(const ExportSource& source, const std::string& path);
    const FilterFormat* filter = nullptr;  // that the format is of; then it writes, and `write` is null
};

Status write_export(const ExportFormat& format, const ExportSource& source, const std::string& path);

// Of --for: of a filter that no ending tells.
ExportFormat export_format_of(const FilterFormat& filter);

std::span<const ExportFormat> export_formats();

// Nothing for an ending that no format has.
const ExportFormat* export_format_of(std::string_view path);

}  // namespace gyrolog
