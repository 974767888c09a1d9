// Any text at all: parsing ends in curves that keep their promises, or in an error with a message.

#include <cmath>
#include <cstdint>
#include <string_view>

#include "host/formats/curve_csv.hpp"
#include "tests/fuzz/require.hpp"

namespace {

void check_promises(const gyrolog::PrintedCurves& curves) {
    GYROLOG_REQUIRE(!curves.curves.empty());
    for (const gyrolog::PrintedCurve& curve : curves.curves) {
        GYROLOG_REQUIRE(!curve.name.empty());
        GYROLOG_REQUIRE(curve.curve.points.size() >= gyrolog::curve_fit_points_min);
        double before_s = 0.0;
        for (const gyrolog::AllanPoint& point : curve.curve.points) {
            GYROLOG_REQUIRE(point.tau_s > 0.0 && point.tau_s >= before_s && std::isfinite(point.tau_s));
            GYROLOG_REQUIRE(point.deviation > 0.0 && std::isfinite(point.deviation));
            before_s = point.tau_s;
        }
    }
}

// What the numbers can be: finite, whatever the curve.
void check_fit(const gyrolog::AllanCurve& curve) {
    const gyrolog::CurveModelFit fit = gyrolog::fit_curve_model(curve);
    GYROLOG_REQUIRE(!fit.terms.empty());
    GYROLOG_REQUIRE(std::isfinite(fit.residual.rms_db));
    for (const gyrolog::CurveTerm& term : fit.terms) {
        GYROLOG_REQUIRE(std::isfinite(term.size) && term.size >= 0.0 && std::isfinite(term.shape));
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto curves = gyrolog::parse_curve_csv(text, "fuzz");
    if (!curves.ok()) {
        GYROLOG_REQUIRE(!curves.error().message.empty());
        return 0;
    }
    check_promises(*curves);
    constexpr std::size_t quick_points = 12;
    const gyrolog::AllanCurve& first = curves->curves.front().curve;
    if (first.points.size() <= quick_points) { check_fit(first); }
    return 0;
}
