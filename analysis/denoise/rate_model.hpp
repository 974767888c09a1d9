// How the true rate may move, for an array filter.
//
//   free    any rate at any sample: the filter combines the units and smooths nothing
//   walk    s_k+1 = s_k + w:                       a first-order low-pass
//   trend   s_k+1 = s_k + a_k + w / 2, a_k+1 = a_k + w:  second order, without lag at constant acceleration
//   adaptive  four trends at once, from a fiftieth of the bandwidth to all of it (adaptive_rate.hpp)
//
// The intensity of w is given as a bandwidth: the frequency at which the settled filter passes half of the
// power of the rate. For a measurement noise r a sample:
//   walk    gain g: H(z) = g / (1 - (1 - g) / z),  var w = r g^2 / (1 - g)
//   trend   alpha-beta filter with tracking index L = sqrt(var w / r) (P. R. Kalata, "The tracking index: a
//           generalized parameter for alpha-beta and alpha-beta-gamma target trackers", IEEE Trans. Aerosp.
//           Electron. Syst. AES-20 (1984) 174-182):
//             q = (4 + L - sqrt(8 L + L^2)) / 4,  alpha = 1 - q^2,  beta = 2 (2 - alpha) - 4 sqrt(1 - alpha)
//             H(z) = (alpha + (beta - alpha) / z) / (1 - (2 - alpha - beta) / z + (1 - alpha) / z^2)
#pragma once

#include <optional>
#include <string_view>

namespace gyrolog {

enum class RateModel { free, walk, trend, adaptive };

struct RateDesign {
    RateModel model = RateModel::free;
    double bandwidth_hz = 0.0;  // unless free: more than 0, less than half the rate
};

std::string_view name_of(RateModel model);
std::optional<RateModel> rate_model(std::string_view name);

// The variance of w over that of the measurement noise, for one sample; 0 for `free` and `adaptive`.
double intensity_of(const RateDesign& design, double rate_hz);

}  // namespace gyrolog
