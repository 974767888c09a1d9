#include "host/app/figure_file.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "analysis/plot/vector_file.hpp"
#include "host/app/option_check.hpp"
#include "host/base/file_output.hpp"

namespace gyrolog {
namespace {

constexpr double figure_width_least_mm = 88.0;
constexpr double figure_width_most_mm = 420.0;  // A3 across
constexpr double figure_dpi_least = 72.0;
constexpr double figure_dpi_most = 600.0;

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

void add_paper_options(CLI::App& app, PaperSize& paper) {
    app.add_option("--plot-width", paper.width_mm,
                   "How wide figures are on paper; letters have 8 pt at any width")
        ->type_name("MM")
        ->check(number_from_to(figure_width_least_mm, figure_width_most_mm, "mm"))
        ->capture_default_str();
    app.add_option("--plot-dpi", paper.dpi, "Pixels in an inch of a figure that is a .png")
        ->type_name("N")
        ->check(number_from_to(figure_dpi_least, figure_dpi_most))
        ->capture_default_str();
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
