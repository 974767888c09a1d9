#include "host/formats/filters/filter_number.hpp"
#include "host/formats/filters/filters.hpp"

namespace gyrolog {
namespace {

constexpr int ardupilot_ek3_step_rate_hz = 80;

constexpr std::string_view ardupilot_ek3_facts[] = {
    "EKF3 adds (number * dt)^2 in each of its steps for noises, and (number * dt^2)^2 for biases, which it "
    "keeps as angles and velocities of one step (ArduPilot, libraries/AP_NavEKF3/AP_NavEKF3_core.cpp, "
    "CovariancePrediction, 003a5c9c65d0). What a number means depends on the step: N / sqrt(dt) and K / "
    "sqrt(dt) here.",
    "The step is the first multiple of the loop's that is above 12 ms less half of one (EKF_TARGET_DT, "
    "AP_NavEKF3_core.h, "
    "the same): 12.5 ms in a loop of 400 Hz, for which the numbers are. For another step multiply all four "
    "by sqrt(12.5 ms / "
    "step); for the 20 ms of a loop of 50 Hz by 0.79.",
    "A noise of the gyro or of a bias above 1 is taken for 1 there. EK3_GYRO_P_NSE from 0.0001 to 0.1, "
    "EK3_ACC_P_NSE from 0.01 to 1, EK3_GBIAS_P_NSE from 0.00001 to 0.001 is what is documented.",
};

constexpr FilterNumber ardupilot_ek3_numbers[] = {
    {"EK3_GYRO_P_NSE", SensorKind::gyro, NoiseTerm::N, "rad/s", once_a_step<ardupilot_ek3_step_rate_hz>, 1.0},
    {"EK3_ACC_P_NSE", SensorKind::accelerometer, NoiseTerm::N, "m/s^2",
     once_a_step<ardupilot_ek3_step_rate_hz>},
    {"EK3_GBIAS_P_NSE", SensorKind::gyro, NoiseTerm::K, "rad/s^2", once_a_step<ardupilot_ek3_step_rate_hz>,
     1.0},
    {"EK3_ABIAS_P_NSE", SensorKind::accelerometer, NoiseTerm::K, "m/s^3",
     once_a_step<ardupilot_ek3_step_rate_hz>, 1.0},
};

}  // namespace

constinit const FilterFormat ardupilot_ek3_format = {
    .name = "ardupilot-ek3",
    .summary = "ArduPilot's EKF3: lines of a .parm file",
    .kind = "Discrete at 80 Hz, the filter's step; the rate of the sensor does not matter.",
    .facts = ardupilot_ek3_facts,
    .numbers = ardupilot_ek3_numbers,
    .line = "{key} {value}",
    .before = "",
    .after = "",
};

}  // namespace gyrolog
