#include "analysis/diagnose/measures/spectrum.hpp"

#include <cmath>

#include "analysis/diagnose/measures/curve_place.hpp"
#include "analysis/diagnose/measures/frequency_bands.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"

namespace gyrolog {

namespace {

double power_dB(double value) { return cube_root_dB(value / 3.0); }

GapCurve spectrum_curve(const Observation& observation, std::size_t axis) {
    const SpectralBins& bins = observation.prediction().bins();
    const AxisObservation& seen = observation.axis(axis);
    const std::vector<std::size_t> edges = band_edges(bins);
    GapCurve curve{&measures::spectrum, axis, axis, {}, {}};
    for (std::size_t band = 0; band + 1 < edges.size(); ++band) {
        double count = 0.0;
        double ratio = 0.0;
        for (std::size_t i = edges[band]; i < edges[band + 1]; ++i) {
            count += bins[i].count();
            ratio += bins[i].count() * seen.power[i] / seen.density[i];
        }
        curve.x.push_back(middle_hz(bins, edges[band], edges[band + 1]));
        curve.value.push_back(3.0 * (std::cbrt(ratio / count) - 1.0));
    }
    return curve;
}

}  // namespace

const Measure measures::spectrum{.name = "spectrum",
                                 .x_name = "frequency (Hz)",
                                 .y_name = "over the model (dB)",
                                 .shown_x = as_it_is,
                                 .shown_y = power_dB,
                                 .locate = locate_frequencies,
                                 .log_x = true,
                                 .is_of_noise = true};

void add_spectrum_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    curves.push_back(spectrum_curve(observation, axis));
}

}  // namespace gyrolog
