// Simulate, analyse, and find what was put in: as near as the analysis says and as often.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>

#include "analysis/noise/analyze.hpp"
#include "analysis/simulate/fitted_model.hpp"
#include "analysis/simulate/sensor_simulator.hpp"
#include "tests/analysis/noise/over_seeds.hpp"

namespace gyrolog {
namespace {

constexpr double duration_s = 7200.0;
constexpr double chance_68 = 0.683;

// White noise gives way to flicker at 0.02 Hz and flicker to the walk at 0.002 Hz, so that two hours show all
// three.
constexpr NoiseCoefficients truth = {.N_rad_per_sqrt_s = 0.01 * rad_per_deg,
                                     .B_rad_per_s = 0.0035 * rad_per_deg,
                                     .K_rad_per_s_sqrt_s = 4e-4 * rad_per_deg};

// A recording of the gyro axes in the model that have noise.
Recording simulated_counts(const SensorModel& model, double rate_hz, double seconds, std::uint64_t seed) {
    Recording recording;
    recording.rate_hz = rate_hz;
    const auto samples = static_cast<std::size_t>(std::llround(seconds * rate_hz));
    recording.segments = {{0, samples, 0}};
    std::array<std::vector<std::int16_t>, 3> counts;
    SensorSimulator simulator(model, rate_hz, seed);
    for (std::size_t done = 0; done < samples; done += block_samples) {
        const SampleBlock& block = simulator.next_block();
        const auto wanted = static_cast<std::ptrdiff_t>(std::min(samples - done, block_samples));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (model.axes[axis].noise.N_rad_per_sqrt_s == 0.0) { continue; }
            counts[axis].insert(counts[axis].end(), block.counts[axis].begin(),
                                block.counts[axis].begin() + wanted);
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (counts[axis].empty()) { continue; }
        recording.columns.push_back({std::string("g") + axis_names[axis], "rad/s", std::move(counts[axis]),
                                     model.lsb_rad_s, 0.0, "lsb"});
    }
    return recording;
}

SensorModel sensor(const NoiseCoefficients& noise) {
    SensorModel model = typical_mpu9250();
    for (AxisModel& axis : model.axes) { axis.noise = noise; }
    return model;
}

struct Coefficient {
    NoiseTerm term;
    double true_value;
};
constexpr Coefficient coefficients[] = {{NoiseTerm::N, truth.N_rad_per_sqrt_s},
                                        {NoiseTerm::B, truth.B_rad_per_s},
                                        {NoiseTerm::K, truth.K_rad_per_s_sqrt_s}};

double best_value(const NoiseFit& fit, NoiseTerm term) {
    const NoiseCoefficients& best = fit.best.coefficients;
    return term == NoiseTerm::N   ? best.N_rad_per_sqrt_s
           : term == NoiseTerm::B ? best.B_rad_per_s
                                  : best.K_rad_per_s_sqrt_s;
}

bool covers(const FittedCoefficient& fitted, double value) {
    return fitted.state == FittedCoefficient::State::identified ? fitted.lo <= value && value <= fitted.hi
                                                                : value <= fitted.upper;
}

// A quick look always, at the lowest rate; GYROLOG_REALISATIONS asks for so many at every rate.
std::size_t seeds() { return test::realisations(20); }
std::vector<double> rates_hz() {
    if (!is_asked("GYROLOG_REALISATIONS")) { return {10.0}; }
    return {10.0, 100.0, 1000.0};
}

std::vector<NoiseFit> found_again(const NoiseCoefficients& noise, double rate_hz) {
    return test::over_seeds(seeds(), [&](std::uint64_t seed) {
        SensorModel model = sensor({});
        model.axes[seed % 3].noise = noise;
        AnalysisOptions options;
        options.threads = 1;
        return analyze(simulated_counts(model, rate_hz, duration_s, seed), options).axes.at(0).fit;
    });
}

struct Found {
    int identified = 0;
    int covered = 0;
    double bias = 0.0;  // relative
    double bias_sd = 0.0;
};

Found found_value(const std::vector<NoiseFit>& fits, NoiseTerm term, double true_value) {
    const auto count = static_cast<double>(fits.size());
    Found found;
    double squares = 0.0;
    for (const NoiseFit& fit : fits) {
        const double error = best_value(fit, term) / true_value - 1.0;
        found.bias += error / count;
        squares += error * error;
        found.identified += fit[term].state == FittedCoefficient::State::identified ? 1 : 0;
        found.covered += covers(fit[term], true_value) ? 1 : 0;
    }
    found.bias_sd = std::sqrt((squares / count - found.bias * found.bias) / (count - 1.0));
    return found;
}

class RoundTrip : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Rates, RoundTrip, testing::ValuesIn(rates_hz()));

TEST_P(RoundTrip, FindsTheSimulatedNoiseWithinItsIntervalsAsOftenAsTheySay) {
    const auto fits = found_again(truth, GetParam());
    const auto count = static_cast<double>(fits.size());
    std::printf("%g Hz, %g h, seeds 1 to %g: found in, bias and its standard error in %%, covered\n",
                GetParam(), duration_s / 3600.0, count);
    for (const Coefficient& coefficient : coefficients) {
        const Found found = found_value(fits, coefficient.term, coefficient.true_value);
        const std::string name(name_of(coefficient.term));
        std::printf("  %s %4d %+7.3f %7.3f %4d\n", name.c_str(), found.identified, 100.0 * found.bias,
                    100.0 * found.bias_sd, found.covered);
        EXPECT_NEAR(found.bias, 0.0, 3.0 * found.bias_sd) << name;
        EXPECT_NEAR(found.covered, chance_68 * count, 3.0 * std::sqrt(chance_68 * (1.0 - chance_68) * count))
            << name;
    }
}

// A simulated sample shows the flicker of its instant, 1/f up to half the rate; the fit counts flicker as
// averaged over the sample, which has less at the top of the band. What is too much there goes to N.
TEST(RoundTripOfStrongFlicker, NIsTooHighByAQuarterOfTheFlickersCrossingOverTheRate) {
    constexpr double rate_hz = 10.0;
    constexpr double crossing_hz = 0.5;  // where flicker is as strong as white noise
    NoiseCoefficients noise = truth;
    noise.B_rad_per_s = truth.N_rad_per_sqrt_s * std::sqrt(2.0 * pi * crossing_hz);
    const Found found = found_value(found_again(noise, rate_hz), NoiseTerm::N, truth.N_rad_per_sqrt_s);
    std::printf("flicker from %g Hz down, at %g Hz: N %+.2f %% +- %.2f %%\n", crossing_hz, rate_hz,
                100.0 * found.bias, 100.0 * found.bias_sd);
    EXPECT_NEAR(found.bias, 0.27 * crossing_hz / rate_hz, 3.0 * found.bias_sd);
}

// sd of the bias of one recording about another's: both hold a walk over their length, and flicker.
double sd_of_means(const NoiseCoefficients& noise, double seconds) {
    return std::sqrt(2.0 * noise.K_rad_per_s_sqrt_s * noise.K_rad_per_s_sqrt_s * seconds / 3.0 +
                     2.0 * noise.allan_variance(seconds));
}

TEST(RoundTripOfAModel, TheModelOfASimulatedModelIsThatModel) {
    constexpr double seconds = 3600.0;
    SensorModel given = sensor(truth);
    given.axes[1].noise.N_rad_per_sqrt_s *= 2.0;
    given.axes[1].noise.B_rad_per_s *= 2.0;
    given.axes[2].noise.K_rad_per_s_sqrt_s = 0.0;
    given.effects = {{.effect = "tone",
                      .axes = {"x"},
                      .params = {{"f_hz", 12.5}, {"amplitude_dps", 0.02}, {"phase_rad", 1.0}},
                      .carried_json = {}}};
    const auto fitted = [&](const SensorModel& model, std::uint64_t seed) {
        const Recording recording = simulated_counts(model, 100.0, seconds, seed);
        return fitted_model(analyze(recording), recording);
    };
    const SensorModel first = fitted(given, 1);
    const SensorModel second = fitted(first, 2);
    const auto expect_same = [](double value, double of_first, double relative_sd, const char* name) {
        EXPECT_NEAR(value / of_first, 1.0, 4.0 * std::sqrt(2.0) * relative_sd) << name;
    };
    for (const SensorModel* model : {&first, &second}) {
        EXPECT_EQ(model->lsb_rad_s, given.lsb_rad_s);
        EXPECT_NEAR(model->saturation_rad_s, given.saturation_rad_s, given.lsb_rad_s);
        EXPECT_EQ(model->rate_hz, given.rate_hz);
        ASSERT_EQ(model->effects.size(), 1U);
        EXPECT_EQ(model->effects[0].effect, "tone");
        EXPECT_EQ(model->effects[0].axes, given.effects[0].axes);
        EXPECT_NEAR(model->effects[0].params.at("f_hz"), 12.5, 1e-4);
        EXPECT_NEAR(model->effects[0].params.at("amplitude_dps"), 0.02, 0.002);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const AxisModel& before = first.axes[axis];
        const AxisModel& after = second.axes[axis];
        expect_same(after.noise.N_rad_per_sqrt_s, before.noise.N_rad_per_sqrt_s, before.sd_rel.at("N"), "N");
        expect_same(after.noise.B_rad_per_s, before.noise.B_rad_per_s, before.sd_rel.at("B"), "B");
        if (before.noise.K_rad_per_s_sqrt_s > 0.0 && after.noise.K_rad_per_s_sqrt_s > 0.0) {
            expect_same(after.noise.K_rad_per_s_sqrt_s, before.noise.K_rad_per_s_sqrt_s,
                        before.sd_rel.at("K"), "K");
        }
        EXPECT_NEAR(after.bias_rad_s, before.bias_rad_s, 4.0 * sd_of_means(given.axes[axis].noise, seconds));
    }
}

}  // namespace
}  // namespace gyrolog
