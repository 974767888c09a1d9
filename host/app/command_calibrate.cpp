#include <memory>

#include "host/app/calibration_run.hpp"
#include "host/app/command.hpp"
#include "host/app/option_check.hpp"
#include "host/app/sensor_choice.hpp"

namespace gyrolog {
namespace {

void setup_outputs(CLI::App& app, CalibrationRequest& request) {
    app.add_option("--model-out", request.model_path,
                   "Write the sensor as a model, for `simulate` and `compare`")
        ->type_name("FILE");
    app.add_option("--json", request.json_path, "Write the calibration as JSON (- for standard output)")
        ->type_name("FILE");
    app.add_option("--px4", request.px4_path, "Write PX4's parameters (CAL_ACC0_XOFF, TC_G0_X1_0, ...)")
        ->type_name("FILE");
    app.add_option("--ardupilot", request.ardupilot_path,
                   "Write ArduPilot's parameters (INS_ACCOFFS_X, INS_TCAL1_GYR1_X, ...)")
        ->type_name("FILE");
    app.add_option("--header", request.header_path, "Write a C header with the numbers and what applies them")
        ->type_name("FILE");
}

}  // namespace

Action setup_calibrate(CLI::App& app) {
    auto request = std::make_shared<CalibrationRequest>();
    app.add_option(
           "RECORDING", request->recordings,
           "Captures (.pcapng), text (.csv, .csv.xz, ...), .mat or .npy of one sensor: rests in six poses or "
           "more, turns, ramps of temperature")
        ->required();
    CLI::Option* const turn =
        app.add_option("--turn", request->turn_deg,
                       "How far each turn about an upright axis went, from rest to rest")
            ->type_name("DEG")
            ->check(positive_number());
    app.add_option("--turn-sd", request->turn_sd_deg, "How well that is known, one sigma; 1 by hand")
        ->type_name("DEG")
        ->check(positive_number())
        ->needs(turn);
    app.add_option("--gravity", request->gravity_m_s2, "Gravity where it was recorded; 9.80665 without")
        ->type_name("M/S2")
        ->check(number_from_to(9.7, 9.9, "m/s^2"));
    add_text_options(app, request->text);
    app.add_option("--lsb-dps", request->lsb_dps, lsb_dps_help)->type_name("DPS")->check(positive_number());
    app.add_option("--lsb-g", request->lsb_g, lsb_g_help)->type_name("G")->check(positive_number());
    app.add_option("--rate", request->rate_hz, "Sampling rate, in place of the file's own")
        ->type_name("HZ")
        ->check(sampling_rate());
    setup_outputs(app, *request);
    return [request](Console& console) { return run_calibration(console, *request); };
}

}  // namespace gyrolog
