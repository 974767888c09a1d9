#include "analysis/diagnose/estimators/spectral_range.hpp"

#include <algorithm>
#include <span>

#include "analysis/diagnose/decision_options.hpp"

namespace gyrolog::resolution {

// How far below the plausible range the size of an effect is still fitted.
constexpr double size_below_plausible = 10.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

SpectralRange spectral_range(const EffectSignature& signature, const EffectParam& param, double rate_hz) {
    const bool is_of_shape = std::ranges::any_of(signature.trials, [&](std::span<const TrialValues> group) {
        return std::ranges::count(group, param.name, &TrialValues::param) > 0;
    });
    const bool is_corner = signature.folds && param.name.ends_with("_hz");
    const double smaller = is_of_shape ? 1.0 : resolution::size_below_plausible;
    SpectralRange range{param.plausible_from / (smaller * decisions.beyond_plausible),
                        param.plausible_to * decisions.beyond_plausible};
    if (is_corner) { range.most = std::min(range.most, 0.5 * rate_hz); }
    if (param.most) { range.most = std::min(range.most, *param.most); }
    return range;
}

}  // namespace gyrolog
