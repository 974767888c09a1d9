#include <memory>
#include <string>

#include "host/app/command.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/result_output.hpp"
#include "host/doctor/doctor.hpp"
#include "host/doctor/udev_rule.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {
namespace {

struct DoctorRequest {
    std::string json;
    std::string root = "/";
    bool writes_udev_rule = false;
};

ExitCode run_doctor(Console& console, const DoctorRequest& request) {
    if (request.writes_udev_rule) {
        console.out << udev_rule_text;
        return ExitCode::ok;
    }
    const NamedPath written[] = {{"--json", request.json}};
    if (const Status fine = check_output_paths({}, written); !fine.ok()) {
        return report_error(console, "doctor", fine.error());
    }
    const std::vector<NamedDiagnostic> found = examine(this_machine(request.root));
    ResultOutput results(console);
    if (request.json != "-") { results.show(doctor_text(found)); }
    results.json(request.json, [&] { return doctor_json(found); });
    if (const Status done = results.finish(); !done.ok()) {
        return report_error(console, "doctor", done.error());
    }
    return nothing_in_the_way(found) ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

Action setup_doctor(CLI::App& app) {
    auto request = std::make_shared<DoctorRequest>();
    app.add_option("--json", request->json, "Write what was found as JSON (- for standard output)")
        ->type_name("FILE");
    app.add_option("--root", request->root, "Look at the files of a machine whose disk is mounted here")
        ->type_name("FOLDER")
        ->check(CLI::ExistingDirectory);
    app.add_flag("--udev-rule", request->writes_udev_rule,
                 "Only print the udev rule that lets users open the boards, for sudo tee")
        ->excludes(app.get_option("--json"), app.get_option("--root"));
    app.footer("Exit status 0: nothing stands in the way; 1: something does.");
    return [request](Console& console) { return run_doctor(console, *request); };
}

}  // namespace gyrolog
