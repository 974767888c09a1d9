#include "host/app/denoise_choice.hpp"

#include <utility>

#include <fmt/format.h>

namespace gyrolog {
namespace {}  // namespace

Result<DenoiseDesign> design_of(const DenoiseChoice& choice, double rate_hz) {
    DenoiseDesign chosen;
    chosen.method = denoise_method(choice.method).value_or(DenoiseMethod::joint);
    chosen.rate = default_rate_design(chosen.method, rate_hz);
    if (chosen.method == DenoiseMethod::wavelet && (choice.bandwidth_hz || !choice.rate_model.empty())) {
        return invalid_argument(
            "--bandwidth and --rate-model are of the Kalman filter: use them with kalman or joint");
    }
    if (!choice.rate_model.empty()) {
        chosen.rate.model = rate_model(choice.rate_model).value_or(RateModel::free);
    }
    if (choice.bandwidth_hz) {
        if (chosen.rate.model == RateModel::free) {
            if (!choice.rate_model.empty()) {
                return invalid_argument("a free rate has no bandwidth: use --rate-model walk or trend");
            }
            chosen.rate.model = RateModel::trend;
        }
        chosen.rate.bandwidth_hz = *choice.bandwidth_hz;
    } else if (chosen.rate.model != RateModel::free && !(chosen.rate.bandwidth_hz > 0.0)) {
        chosen.rate.bandwidth_hz = default_rate_design(DenoiseMethod::joint, rate_hz).bandwidth_hz;
    }
    if (chosen.rate.model != RateModel::free && !(chosen.rate.bandwidth_hz < 0.45 * rate_hz)) {
        return invalid_argument(
            fmt::format("--bandwidth {:g} Hz: less than {:.4g} Hz, 0.45 of the rate, can be told apart from "
                        "noise; --rate-model free passes everything",
                        chosen.rate.bandwidth_hz, 0.45 * rate_hz));
    }
    chosen.gain = choice.gain == "steady" ? FilterGain::steady : FilterGain::varying;
    chosen.window = choice.window;
    chosen.watch = !choice.watch_off;
    return chosen;
}

}  // namespace gyrolog
