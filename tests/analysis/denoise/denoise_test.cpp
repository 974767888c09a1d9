#include "analysis/denoise/denoise.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 200.0;
constexpr std::size_t still_rows = 24'000;
constexpr std::size_t rows = 36'000;

// Two minutes at rest, then one of slow turns.
Recording moving_array(const ArrayNoise& noise, std::uint64_t seed = 71) {
    Signal rate(rows, 0.0);
    for (std::size_t i = still_rows; i < rows; ++i) {
        rate[i] = 5.0 * std::sin(6.283185307179586 * 0.2 * static_cast<double>(i - still_rows) / rate_hz);
    }
    const ArraySamples samples = array_samples(noise, rate, seed);
    Recording recording;
    recording.name = "array";
    recording.rate_hz = rate_hz;
    recording.segments = {{0, rows, 0}};
    for (std::size_t i = 0; i < samples.size(); ++i) {
        recording.columns.push_back({"gx" + std::to_string(i + 1), "rad/s", samples[i]});
    }
    recording.columns.push_back({"ref_x", "rad/s", rate});
    recording.columns.push_back({"temp", "degC", Signal(rows, 25.0)});
    return recording;
}

std::vector<AxisKnowledge> learned(const Recording& recording) {
    const ArrayAxis axis = array_axes(recording).front();
    return learn_units(
        rows_of(recording, axis.units, segments_within(recording.segments, rate_hz, {0.0, 120.0})),
        std::nullopt);
}

DenoiseRequest request_of(std::initializer_list<DenoiseMethod> methods) {
    DenoiseRequest request;
    request.still = {0.0, 120.0};
    for (const DenoiseMethod method : methods) {
        DenoiseDesign design;
        design.method = method;
        design.rate = default_rate_design(method, rate_hz);
        request.designs.push_back(design);
    }
    return request;
}

TEST(Denoise, LearnsTheUnitsFromThePartAtRest) {
    ArrayNoise noise = equal_units(3, 0.1, 1e-5);
    noise.units[1].white_variance = 0.04;
    noise.white_correlation = equal_correlation(3, 0.3);
    const std::vector<AxisKnowledge> axes = learned(moving_array(noise));
    ASSERT_EQ(axes.size(), 1U);
    const AxisKnowledge& axis = axes.front();
    EXPECT_NEAR(axis.noise.units[0].white_variance, 0.01, 0.0005);
    EXPECT_NEAR(axis.noise.units[1].white_variance, 0.04, 0.002);
    // Some 24000 differences: to 5 / sqrt(24000).
    EXPECT_NEAR(axis.noise.white_correlation[1], 0.3, 0.035);
    EXPECT_GT(axis.white_differences, 20'000U);
    EXPECT_NEAR(axis.bands.front().gain_limit(), 1.0 / 0.3, 0.4);
}

TEST(Denoise, IndependentUnitsAreTakenForIndependent) {
    const std::vector<AxisKnowledge> axes = learned(moving_array(equal_units(4, 0.1, 1e-5)));
    const std::vector<double>& found = axes.front().noise.white_correlation;
    for (std::size_t i = 0; i < found.size(); ++i) {
        // Twice the chance deviation may be passed now and then, never three times.
        EXPECT_LT(std::abs(found[i] - (i % 5 == 0 ? 1.0 : 0.0)), 3.0 / std::sqrt(24'000.0)) << i;
    }
}

TEST(Denoise, TellsVarianceLagAndNoiseOfEachMethod) {
    const Recording recording = moving_array(equal_units(3, 0.1, 1e-6));
    const auto axes =
        denoise(recording, learned(recording),
                request_of({DenoiseMethod::joint, DenoiseMethod::kalman, DenoiseMethod::wavelet}));
    ASSERT_EQ(axes.size(), 1U);
    const AxisDenoising& axis = axes.front();
    EXPECT_NEAR(axis.unit_variance(), 0.01, 0.0005);
    EXPECT_NEAR(axis.mean_variance, 0.01 / 3.0, 0.0002);
    EXPECT_NEAR(axis.signals[1].still_variance, 0.01 / 3.0, 0.0002);
    for (const DenoisedSignal& signal : axis.signals) {
        // What the answer to single samples promises: details above their threshold add some to the
        // wavelet's. An adaptive rate lies between its narrowest and its widest model.
        EXPECT_GT(signal.still_variance, 0.8 * signal.calm.noise_ratio * 0.01)
            << name_of(signal.design.method);
        EXPECT_LT(signal.still_variance, 1.5 * signal.response.noise_ratio * 0.01)
            << name_of(signal.design.method);
        ASSERT_TRUE(signal.motion);
        EXPECT_NEAR(signal.motion->gain, 1.0, 0.02) << name_of(signal.design.method);
        EXPECT_LT(std::abs(signal.motion->lag_s), 0.015);
        EXPECT_FALSE(signal.allan.points.empty());
        EXPECT_FALSE(signal.spectrum.points.empty());
    }
    EXPECT_LT(axis.signals[0].still_variance, axis.signals[2].still_variance);
    EXPECT_TRUE(axis.failures.empty());
}

TEST(Denoise, IsCausal) {
    const Recording whole = moving_array(equal_units(2, 0.1, 1e-6));
    const std::vector<AxisKnowledge> knowledge = learned(whole);
    DenoiseRequest request = request_of({DenoiseMethod::joint});
    request.details = false;
    const auto all = denoise(whole, knowledge, request);
    const auto beginning = denoise(first_rows(whole, 20'000), knowledge, request);
    const std::vector<double>& rate = beginning.front().signals.front().rate;
    for (std::size_t i = 0; i < rate.size(); ++i) {
        ASSERT_EQ(rate[i], all.front().signals.front().rate[i]) << i;
    }
}

TEST(Denoise, GivesTheRecordingWithOneRateAnAxisAndTheOtherColumns) {
    const Recording recording = moving_array(equal_units(2, 0.1, 1e-6));
    DenoiseRequest request = request_of({DenoiseMethod::kalman});
    request.details = false;
    const Recording result = denoised_recording(recording, denoise(recording, learned(recording), request));
    ASSERT_EQ(result.columns.size(), 3U);
    EXPECT_EQ(result.columns[0].name, "gx");
    EXPECT_EQ(result.columns[1].name, "ref_x");
    EXPECT_EQ(result.columns[2].name, "temp");
    EXPECT_EQ(result.rows(), rows);
}

TEST(Denoise, NotesWhichUnitWasLeftOutAndWhen) {
    Recording recording = moving_array(equal_units(3, 0.1, 1e-6));
    const std::vector<AxisKnowledge> knowledge = learned(recording);
    auto& second = std::get<Signal>(recording.columns[1].data);
    for (std::size_t i = 30'000; i < 31'000; ++i) { second[i] = 0.125; }
    DenoiseRequest request = request_of({DenoiseMethod::kalman});
    const auto axes = denoise(recording, knowledge, request);
    ASSERT_FALSE(axes.front().failures.empty());
    std::size_t left_out = 0;
    for (const UnitFailure& failure : axes.front().failures) {
        EXPECT_EQ(failure.unit, "2");
        EXPECT_GE(failure.from_s, 150.0);
        left_out += failure.samples;
    }
    EXPECT_GT(left_out, 980U);
    // The mean of the other two does not notice.
    const std::vector<double>& rate = axes.front().signals.front().rate;
    double squares = 0.0;
    for (std::size_t i = 30'050; i < 31'000; ++i) {
        const double reference = recording.columns[3].value(i);
        squares += std::pow(rate[i] - reference, 2) / 950.0;
    }
    EXPECT_NEAR(squares, 0.005, 0.005 * 5.0 * std::sqrt(2.0 / 950.0) + 5e-4);
}

TEST(Denoise, BridgesHolesWithoutTakingTheirEndsForMotion) {
    Recording recording = moving_array(equal_units(2, 0.1, 1e-6));
    recording.segments = {{0, 10'000, 0}, {10'000, rows - 10'000, 50'000}};
    const std::vector<AxisKnowledge> knowledge = learned(recording);
    const auto axes = denoise(recording, knowledge, request_of({DenoiseMethod::joint}));
    const std::vector<double>& rate = axes.front().signals.front().rate;
    for (std::size_t i = 10'000; i < 10'014; ++i) { EXPECT_LT(std::abs(rate[i]), 0.5) << i; }
}

TEST(Denoise, GivenModelsTakeThePlaceOfFittedOnes) {
    const Recording recording = moving_array(equal_units(2, 0.1, 1e-6));
    std::vector<AxisKnowledge> knowledge = learned(recording);
    NoiseModel quiet;
    quiet.coefficients.N_rad_per_sqrt_s = 0.01;
    NoiseModel loud;
    loud.coefficients.N_rad_per_sqrt_s = 0.03;
    use_models(knowledge, {{quiet, loud}});
    DenoiseRequest request = request_of({DenoiseMethod::kalman});
    request.details = false;
    const auto axes = denoise(recording, knowledge, request);
    EXPECT_NEAR(axes.front().sample_weights[0], 0.9, 0.01);
}

}  // namespace
}  // namespace gyrolog
