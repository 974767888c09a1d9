// Figures as files, in the form that the name's ending says.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "analysis/plot/figure.hpp"
#include "analysis/plot/paper_size.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// What stands for the name of such a file in a command's help.
inline constexpr const char* figure_file_type = "FILE.png|svg|pdf";

// --plot-width and --plot-dpi, of a command that has --plot. `paper` outlives the parsing.
void add_paper_options(CLI::App& app, PaperSize& paper);

// A name that ends in .png, .svg or .pdf.
CLI::Validator figure_file();
bool is_figure_file(const std::string& path);

// Error failed, with the path, for a figure that could not be drawn; otherwise those of write_file(). A name
// with another ending (a pipe that the program itself chose) takes a PNG.
Status write_figure(const Rendering& rendering, const std::string& path);

}  // namespace gyrolog
