#include "host/formats/filters/filter_number.hpp"
#include "host/formats/filters/filters.hpp"
#include "host/formats/python_encoding.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view gtsam_facts[] = {
    "Squares of densities. GTSAM adds covariance / dt * dt^2 for noises, covariance * dt for biases and for "
    "integrationCovariance (gtsam/navigation/CombinedImuFactor.cpp, integrateMeasurement, 00c797b7fc23).",
    "biasAccOmegaInt is the covariance of the bias at the start, and is added once in each step, as if it "
    "were "
    "white noise (the same). Its default is the unit matrix, (1 rad/s)^2: much more than the sensor's noise. "
    "It is zero here; the prior of the first bias in your graph is where it belongs.",
    "The defaults of biasAccCovariance and biasOmegaCovariance are unit matrices as well "
    "(PreintegrationCombinedParams.h, 005c7d4e2deb).",
    "integrationCovariance is no property of the sensor: 1e-8 m^2/s, 0.1 mm after a second, keeps the "
    "covariance of one step regular.",
};

constexpr FilterNumber gtsam_numbers[] = {
    {"GyroscopeCovariance", SensorKind::gyro, NoiseTerm::N, "(rad/s)^2/Hz", squared},
    {"AccelerometerCovariance", SensorKind::accelerometer, NoiseTerm::N, "(m/s^2)^2/Hz", squared},
    {"BiasOmegaCovariance", SensorKind::gyro, NoiseTerm::K, "(rad/s^2)^2/Hz", squared},
    {"BiasAccCovariance", SensorKind::accelerometer, NoiseTerm::K, "(m/s^3)^2/Hz", squared},
};

}  // namespace

constinit const FilterFormat gtsam_format = {
    .name = "gtsam",
    .summary = "GTSAM: PreintegrationCombinedParams, in Python",
    .kind = "Continuous-time covariances.",
    .facts = gtsam_facts,
    .numbers = gtsam_numbers,
    .line = "params.set{key}({value} * np.eye(3))",
    .before =
        "import gtsam\nimport numpy as np\n\n"
        "params = gtsam.PreintegrationCombinedParams.MakeSharedU(9.80665)  # z upward; MakeSharedD: down\n"
        "params.setIntegrationCovariance(1.0e-8 * np.eye(3))\n"
        "params.setBiasAccOmegaInit(np.zeros((6, 6)))\n",
    .after = "",
    .first = python_encoding_line,
    .missing = "raise ValueError(\"{key} is missing: GTSAM would take a default of 1\")",
};

}  // namespace gyrolog
