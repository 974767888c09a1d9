#include "host/app/part_options.hpp"

#include <string>

#include "host/app/option_check.hpp"
#include "host/app/quantity.hpp"

namespace gyrolog {
namespace {

// The start, which no duration is.
double start_s(const std::string& text) { return text == "0" ? 0.0 : *parse_duration_s(text); }

}  // namespace

void add_time_options(CLI::App& app, PartChoice& part) {
    app.add_option_function<std::string>(
           "--from", [&part](const std::string& text) { part.from_s = start_s(text); },
           "Leave out what lies before this time of the recording")
        ->type_name("TIME")
        ->check(duration_or_none());
    app.add_option_function<std::string>(
           "--to", [&part](const std::string& text) { part.to_s = *parse_duration_s(text); },
           "Leave out what lies after this time of the recording")
        ->type_name("TIME")
        ->check(duration());
}

void add_part_options(CLI::App& app, PartChoice& part) {
    add_time_options(app, part);
    app.add_option_function<std::string>(
           "--still", [&part](const std::string&) { part.is_still = true; },
           "auto: of the recording, or of what --from and --to leave, the longest part in which nothing "
           "turns")
        ->type_name("auto")
        ->check(CLI::IsMember({"auto"}));
}

}  // namespace gyrolog
