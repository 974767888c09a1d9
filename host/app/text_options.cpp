#include "host/app/text_options.hpp"

#include <string>

#include "host/app/option_check.hpp"

namespace gyrolog {
namespace {

CLI::Validator part_of_choice(std::string ColumnChoice::*part) {
    return {[part](const std::string& text) -> std::string {
                ColumnChoice choice;
                choice.*part = text;
                const Status fine = check_column_choice(choice);
                return fine.ok() ? "" : fine.error().message;
            },
            ""};
}

}  // namespace

void add_text_options(CLI::App& app, TextChoice& choice) {
    app.add_option(
           "--columns", choice.columns,
           "What the columns are: t,gx,gy,gz by position (_ leaves one out), for a file without names or "
           "in place of its own; or NAME=gx_dps,... for some")
        ->type_name("NAMES")
        ->check(part_of_choice(&ColumnChoice::columns));
    app.add_option("--unit", choice.gyro_unit,
                   "Unit of gyro columns whose names have none: deg/s, rad/s, deg/h or lsb")
        ->type_name("UNIT")
        ->check(part_of_choice(&ColumnChoice::gyro_unit))
        ->check(offered({"deg/s", "rad/s", "deg/h", "lsb"}));
    app.add_option("--acc-unit", choice.accelerometer_unit,
                   "The same of accelerometer columns: g, m/s^2 or lsb")
        ->type_name("UNIT")
        ->check(part_of_choice(&ColumnChoice::accelerometer_unit))
        ->check(offered({"g", "m/s^2", "lsb"}));
}

}  // namespace gyrolog
