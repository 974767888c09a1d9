#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "analysis/diagnose/measures/rate_change.hpp"
#include "analysis/diagnose/measures/reference_rate.hpp"
#include "tests/analysis/diagnose/measures/changed_codes.hpp"

namespace gyrolog {
namespace {

double rate_rad_s(double t_s) {
    return 1.5 * std::sin(2.0 * pi * 0.31 * t_s) * std::sin(2.0 * pi * 0.011 * t_s);
}

// Of a sensor that answers with `more`, beside the rate, on its x axis.
std::vector<GapCurve> curves_with(const std::function<double(double t_s)>& more) {
    const auto world = world_turning([](double t_s) {
        return Vector3{rate_rad_s(t_s), 0.8 * rate_rad_s(0.7 * t_s), 0.5 * rate_rad_s(1.3 * t_s)};
    });
    SensorModel model = calibrated_sensor();
    model.sd_abs = {{"latency_s", 1e-7}};  // what is late is not the model's
    Recording recording = *recorded(model, 60'000, 3, world);
    Column& column = *std::ranges::find(recording.columns, std::string("gx"), &Column::name);
    std::vector<double> numbers;
    for (std::size_t row = 0; row < column.size(); ++row) {
        const double t_s = static_cast<double>(row) / recording.rate_hz;
        numbers.push_back((column.value(row) + more(t_s) - column.offset) / column.scale);
    }
    column.data = std::move(numbers);
    const auto seen = std::make_shared<const Recording>(recording);
    return gap_curves(Observation(prediction_of(seen, model), seen, 1));
}

double change_rad_s2(double t_s) { return (rate_rad_s(t_s + 0.005) - rate_rad_s(t_s - 0.005)) / 0.01; }

TEST(MotionCurves, OfAnOrdinarySensorAreSmall) {
    const std::vector<GapCurve> curves = curves_with([](double) { return 0.0; });
    for (const Measure* measure :
         {&measures::gain_course, &measures::delay_course, &measures::acceleration}) {
        for (const double value : curve_of(curves, *measure, 0).value) { EXPECT_LT(std::fabs(value), 4.5); }
    }
}

TEST(MotionCurves, ShowWhenAnAxisIsLate) {
    const std::vector<GapCurve> curves = curves_with(
        [](double t_s) { return t_s > 200.0 && t_s < 300.0 ? -0.0004 * change_rad_s2(t_s) : 0.0; });
    const GapCurve& late = curve_of(curves, measures::delay_course, 0);
    for (std::size_t i = 0; i < late.x.size(); ++i) {
        const bool inside = late.x[i] > 225.0 && late.x[i] < 275.0;
        const bool outside = late.x[i] < 175.0 || late.x[i] > 325.0;
        if (inside) { EXPECT_LT(late.value[i], -6.0) << late.x[i]; }
        if (outside) { EXPECT_GT(late.value[i], -4.5) << late.x[i]; }
    }
}

TEST(MotionCurves, ShowWhenTheGainIsOff) {
    const std::vector<GapCurve> curves =
        curves_with([](double t_s) { return t_s > 450.0 ? 0.0004 * rate_rad_s(t_s) : 0.0; });
    const GapCurve& gain = curve_of(curves, measures::gain_course, 0);
    EXPECT_GT(gain.value.back(), 6.0);
    EXPECT_LT(gain.value.front(), 4.5);
}

// Play: a step where the rate turns, of the same size for a slow turn and a fast one.
TEST(MotionCurves, ShowWhatDependsOnTheDirectionOfTheChange) {
    const std::vector<GapCurve> curves =
        curves_with([](double t_s) { return change_rad_s2(t_s) > 0.0 ? -1e-4 : 1e-4; });
    const GapCurve& change = curve_of(curves, measures::acceleration, 0);
    EXPECT_TRUE(std::ranges::is_sorted(change.x));
    // As many samples in every range: the sines are more often slow than fast.
    const std::size_t middle = change.x.size() / 2;
    EXPECT_LT(2.0 * (change.x[middle] - change.x[middle - 1]), change.x.back() - *(change.x.end() - 2));
    for (std::size_t i = 0; i < change.x.size(); ++i) {
        // Of faster ones the clock, which the model does not know better, takes a part.
        if (std::fabs(change.x[i]) > 1.0) { continue; }
        EXPECT_GT(change.x[i] > 0.0 ? -change.value[i] : change.value[i], 3.0) << change.x[i];
    }
}

}  // namespace
}  // namespace gyrolog
