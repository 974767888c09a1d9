#include <memory>

#include "host/app/capture_run.hpp"
#include "host/app/command.hpp"

namespace gyrolog {

Action setup_capture(CLI::App& app) {
    struct Options {
        CaptureOptions capture;
        std::string path;
    };
    auto options = std::make_shared<Options>();
    app.add_option("-o,--output", options->path, "The capture to write (.pcapng)")
        ->type_name("FILE")
        ->required();
    options->capture.declare(app);
    return [options](Console& console) {
        return capture_to_file(console, "capture", options->capture, options->path, false).code;
    };
}

}  // namespace gyrolog
