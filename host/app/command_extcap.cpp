// What Wireshark asks of a program in its extcap folder (doc/extcap_example.py and extcap(4) of Wireshark):
// which interfaces there are, what they carry and take, and a capture into a named pipe.
#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "host/app/capture_options.hpp"
#include "host/app/command.hpp"
#include "host/app/stop_signal.hpp"
#include "host/capture/pipe_disk.hpp"
#include "host/session/open_source.hpp"
#include "host/usb/usb_board.hpp"

namespace gyrolog {
namespace {

constexpr const char* simulated_interface = "gyrolog-sim";
constexpr const char* usb_interface = "gyrolog-usb";

struct ExtcapOptions {
    bool interfaces = false;
    bool dlts = false;
    bool config = false;
    bool capture = false;
    std::string interface;
    std::string fifo;
    std::string simulation;
    std::string ignored;
    CaptureOptions board;
};

struct Interface {
    std::string name;
    std::string title;
    std::string uri;
};

// Wireshark reads names between braces, and makes file names of them.
std::string in_name(std::string text) {
    for (char& c : text) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
        if (!plain) { c = '_'; }
    }
    return text;
}

// Boards that are there, whether or not they can be opened, and the simulated one. A machine without USB has
// that one.
std::vector<Interface> all_interfaces() {
    std::vector<Interface> found;
    auto usb = UsbContext::create();
    const auto survey = usb.ok() ? survey_usb(**usb) : Result<UsbSurvey>(usb.error());
    if (survey.ok()) {
        for (const UsbBoard& board : survey->boards) {
            const std::string serial = in_name(board.serial);
            found.push_back({serial.empty() ? usb_interface : usb_interface + ("-" + serial),
                             "gyrolog board" + (serial.empty() ? serial : " " + serial), board.uri()});
        }
    }
    found.push_back({simulated_interface, "gyrolog simulated board", "sim:"});
    return found;
}

ExitCode tell_interfaces(Console& console) {
    console.out << "extcap {version=1}{display=gyrolog}\n";
    for (const Interface& one : all_interfaces()) {
        console.out << fmt::format("interface {{value={}}}{{display={}}}\n", one.name, one.title);
    }
    return ExitCode::ok;
}

ExitCode tell_link_type(Console& console) {
    console.out
        << "dlt {number=220}{name=USB_LINUX_MMAPPED}{display=USB transfers with the kernel's header}\n";
    return ExitCode::ok;
}

ExitCode tell_settings(Console& console, const std::string& interface) {
    console.out << "arg {number=0}{call=--rate}{display=Rate}{type=double}{tooltip=Samples a second; empty: "
                   "as the board is}\n"
                   "arg {number=1}{call=--full-scale}{display=Full scale}{type=integer}"
                   "{tooltip=deg/s: 250, 500, 1000 or 2000; empty: as the board is}\n"
                   "arg {number=2}{call=--dlpf}{display=Low-pass filter}{type=string}"
                   "{tooltip=Bandwidth in Hz, or off; empty: as the board is}\n";
    if (interface == simulated_interface) {
        console.out << "arg {number=3}{call=--sim}{display=Simulation}{type=string}"
                       "{tooltip=As behind sim: of gyrolog capture --device: model=FILE,seed=7}\n";
    }
    return ExitCode::ok;
}

Result<std::string> uri_of(const ExtcapOptions& options) {
    if (options.interface == simulated_interface) { return "sim:" + options.simulation; }
    std::vector<std::string> names;
    for (const Interface& one : all_interfaces()) {
        if (one.name == options.interface) { return one.uri; }
        names.push_back(one.name);
    }
    return Error{ErrorCode::not_found, fmt::format("there is no interface '{}', only {}", options.interface,
                                                   fmt::join(names, ", "))};
}

// Wireshark shows whatever comes on `err` as an error, so that nothing does unless it is one.
ExitCode capture_to_pipe(Console& console, const ExtcapOptions& options) {
    const auto fail = [&](const Error& error) { return report_error(console, "extcap", error); };
    if (options.fifo.empty()) { return fail({ErrorCode::invalid_argument, "--capture needs --fifo FILE"}); }
    const auto uri = uri_of(options);
    if (!uri.ok()) { return fail(uri.error()); }
    auto request = options.board.request();
    if (!request.ok()) { return fail(request.error()); }
    auto opened = open_source(*uri, {request->duration_s, request->samples}, true);
    if (!opened.ok()) {
        fail(opened.error());
        return exit_code_of_opening(opened.error());
    }
    const auto pipe = PipeDisk::open(options.fifo);
    if (!pipe.ok()) { return fail(pipe.error()); }
    request->path = options.fifo;
    request->disk = pipe->get();
    request->min_free_bytes = 0;
    request->on_unplug = OnUnplug::end;  // a pipe has no second file to go on in
    const TidyEnd tidy;
    const auto outcome = run_capture(*opened->source, *request,
                                     [&](const CaptureProgress&) { return !console.stop_wanted(); });
    if ((*pipe)->is_left() || console.stop_wanted()) { return ExitCode::ok; }  // Wireshark's way to end it
    if (!outcome.ok()) {
        fail(outcome.error());
        return exit_code_of_opening(outcome.error());
    }
    if (outcome->error) { return fail(*outcome->error); }
    return ExitCode::ok;
}

ExitCode answer(Console& console, const ExtcapOptions& options) {
    if (options.interfaces) { return tell_interfaces(console); }
    if (options.interface.empty()) {
        return report_error(console, "extcap",
                            {ErrorCode::invalid_argument,
                             "give --extcap-interfaces, or --extcap-interface NAME with --extcap-dlts, "
                             "--extcap-config or --capture"});
    }
    if (options.dlts) { return tell_link_type(console); }
    if (options.config) { return tell_settings(console, options.interface); }
    if (options.capture) { return capture_to_pipe(console, options); }
    return report_error(console, "extcap",
                        {ErrorCode::invalid_argument, "give --extcap-dlts, --extcap-config or --capture"});
}

}  // namespace

Action setup_extcap(CLI::App& app) {
    auto options = std::make_shared<ExtcapOptions>();
    app.add_flag("--extcap-interfaces", options->interfaces, "List the interfaces");
    app.add_option("--extcap-version", options->ignored, "Wireshark's version: any does")
        ->type_name("VERSION")
        ->expected(0, 1);
    app.add_option("--extcap-interface", options->interface, "The interface that is meant")
        ->type_name("NAME");
    app.add_flag("--extcap-dlts", options->dlts, "Tell its link type");
    app.add_flag("--extcap-config", options->config, "Tell its settings");
    app.add_flag("--capture", options->capture, "Capture from it until the pipe's reader leaves");
    app.add_option("--fifo", options->fifo, "The named pipe to capture into")->type_name("FILE");
    app.add_option("--extcap-capture-filter", options->ignored, "Passed over: all is captured")
        ->type_name("FILTER")
        ->expected(0, 1);
    app.add_option("--sim", options->simulation, "Of gyrolog-sim: KEY=VALUE,... as behind sim:")
        ->type_name("KEY=VALUE,...");
    options->board.declare_settings(app);
    return [options](Console& console) { return answer(console, *options); };
}

}  // namespace gyrolog
