#include "host/app/figure_file.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "analysis/plot/vector_file.hpp"
#include "host/base/file_output.hpp"

namespace gyrolog {
namespace {

bool ends_in(std::string path, std::string_view ending) {
    std::ranges::transform(path, path.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return path.ends_with(ending);
}

}  // namespace

bool is_figure_file(const std::string& path) {
    return ends_in(path, ".png") || ends_in(path, ".svg") || ends_in(path, ".pdf");
}

CLI::Validator figure_file() {
    return {[](const std::string& path) -> std::string {
                if (is_figure_file(path)) { return ""; }
                return fmt::format("'{}' does not end in .png, .svg or .pdf: a figure has no other form",
                                   path);
            },
            ""};
}

Status write_figure(const Rendering& rendering, const std::string& path) {
    if (!rendering.ok()) { return Error{ErrorCode::failed, "draw '" + path + "': " + rendering.problem}; }
    if (ends_in(path, ".svg")) {
        return write_file(path, encode_vector(rendering.drawing, VectorFormat::svg));
    }
    if (ends_in(path, ".pdf")) {
        return write_file(path, encode_vector(rendering.drawing, VectorFormat::pdf));
    }
    return write_file(path, rendering.png);
}

}  // namespace gyrolog
