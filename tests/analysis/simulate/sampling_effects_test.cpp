// The effects of the clock, of lost and repeated samples, and of the converter.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/simulate/chain.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;

// The x axis shows the moment of the world that each sample comes from.
std::shared_ptr<FormulaWorld> clock_world() {
    auto world = world_turning([](double t_s) { return Vector3{t_s, 0.0, 0.0}; });
    world->temperature_C = [](double t_s) { return t_s; };
    return world;
}

TEST(Latency, ShowsTheWorldOfItsDelayBeforeTheStamp) {
    SensorModel model = with_effect(ideal_model(), "latency", {{"delay_s", 0.004}});
    model.latency_s = 0.001;
    const Simulated run = simulate(model, rate_hz, 1, 1, clock_world());
    for (std::size_t i = 0; i < run.size(); ++i) {
        ASSERT_NEAR(run.rate_rad_s[0][i], static_cast<double>(i) / rate_hz - 0.005, 1e-14);
        ASSERT_EQ(run.stamp_s[i], static_cast<double>(i) * (1.0 / rate_hz));
    }
}

TEST(ClockRate, TrueStampsShowItAndTheWorldStaysInStep) {
    SensorModel model = with_effect(ideal_model(), "clock_rate", {{"rel", 0.01}});
    model.latency_s = 0.001;
    const Simulated run = simulate(model, rate_hz, 1, 2, clock_world());
    for (std::size_t i = 0; i < run.size(); ++i) {
        ASSERT_NEAR(run.stamp_s[i], static_cast<double>(i) / (rate_hz * 1.01), 1e-12);
        ASSERT_NEAR(run.rate_rad_s[0][i], run.stamp_s[i] - 0.001, 1e-12);
    }
}

TEST(ClockRate, NominalStampsHideItAndTheWorldRunsAway) {
    const SensorModel model = with_effect(ideal_model(), "clock_rate", {{"rel", 0.01}, {"in_stamps", 0.0}});
    const Simulated run = simulate(model, rate_hz, 1, 2, clock_world());
    for (std::size_t i = 0; i < run.size(); ++i) {
        ASSERT_NEAR(run.stamp_s[i], static_cast<double>(i) / rate_hz, 1e-12);
        ASSERT_NEAR(run.rate_rad_s[0][i], run.stamp_s[i] / 1.01, 1e-12);
    }
}

// Whatever happens in time happens at the true time, and noise has its density at the true rate.
TEST(ClockRate, IsTheRateOfTheWholeSensor) {
    for (const double in_stamps : {0.0, 1.0}) {
        SensorModel model =
            with_effect(ideal_model(), "clock_rate", {{"rel", 0.01}, {"in_stamps", in_stamps}});
        model.effects.push_back(effect_entry("tone", {{"f_hz", 5.0}, {"amplitude_dps", deg_per_rad}}));
        model.effects.push_back(
            effect_entry("bias_step", {{"step_dps", 100.0 * deg_per_rad}, {"at_s", 10.0}}));
        const Simulated run = simulate(model, rate_hz, 1, 2);
        for (std::size_t i = 0; i < run.size(); ++i) {
            const double t_s = static_cast<double>(i) / (rate_hz * 1.01);
            const double step = t_s >= 10.0 ? 100.0 : 0.0;
            ASSERT_NEAR(run.rate_rad_s[0][i], std::sin(10.0 * pi * t_s) + step, 1e-9) << i;
        }
    }
    SensorModel noisy = with_effect(ideal_model(), "clock_rate", {{"rel", 0.21}});
    noisy.axes[0].noise.N_rad_per_sqrt_s = 1.0;
    SensorModel plain = noisy;
    plain.effects.clear();
    const Simulated fast = simulate(noisy, rate_hz, 1, 1);
    const Simulated nominal = simulate(plain, rate_hz, 1, 1);
    for (std::size_t i = 0; i < fast.size(); ++i) {
        ASSERT_NEAR(fast.rate_rad_s[0][i], 1.1 * nominal.rate_rad_s[0][i], 1e-9);
    }
}

TEST(ClockJitter, OfTheSamplesShowsInATone) {
    SensorModel model = with_effect(ideal_model(), "clock_jitter", {{"sd_s", 0.002}, {"in_stamps", 0.0}});
    model.effects.push_back(effect_entry("tone", {{"f_hz", 1.0}, {"amplitude_dps", deg_per_rad}}));
    const Simulated run = simulate(model, rate_hz, 1, 20);
    double sum = 0.0;
    for (std::size_t i = 0; i < run.size(); ++i) {
        const double off = run.rate_rad_s[0][i] - std::sin(2.0 * pi * static_cast<double>(i) / rate_hz);
        sum += off * off;
    }
    // The slope's mean square, 2 pi^2, times the variance of the instants; 20480 samples, 4 standard errors.
    EXPECT_NEAR(sum / static_cast<double>(run.size()) / (2.0 * pi * pi * 0.002 * 0.002), 1.0, 0.06);
}

// The scatter of what should be regular.
void expect_independent_scatter(const std::vector<double>& instants_s, double sd_s) {
    double variance = 0.0;
    double neighbours = 0.0;
    double before = 0.0;
    for (std::size_t i = 0; i < instants_s.size(); ++i) {
        const double off_s = instants_s[i] - static_cast<double>(i) / rate_hz;
        variance += off_s * off_s;
        neighbours += off_s * before;
        before = off_s;
    }
    const auto n = static_cast<double>(instants_s.size());
    EXPECT_NEAR(variance / (n * sd_s * sd_s), 1.0, 4.0 * std::sqrt(2.0 / n));
    EXPECT_NEAR(neighbours / (n * sd_s * sd_s), 0.0, 4.0 / std::sqrt(n));
}

TEST(ClockJitter, InTheStampsLeavesTheSamplesRegular) {
    const SensorModel model = with_effect(ideal_model(), "clock_jitter", {{"sd_s", 1e-3}});
    const Simulated run = simulate(model, rate_hz, 1, 20, clock_world());
    expect_independent_scatter(run.stamp_s, 1e-3);
    for (std::size_t i = 0; i < run.size(); ++i) {
        ASSERT_NEAR(run.rate_rad_s[0][i], static_cast<double>(i) / rate_hz, 1e-12);
    }
}

TEST(ClockJitter, InTheInstantsLeavesTheStampsRegular) {
    const SensorModel model =
        with_effect(ideal_model(), "clock_jitter", {{"sd_s", 1e-3}, {"in_stamps", 0.0}});
    const Simulated run = simulate(model, rate_hz, 1, 20, clock_world());
    expect_independent_scatter(run.rate_rad_s[0], 1e-3);
    for (std::size_t i = 0; i < run.size(); ++i) {
        ASSERT_EQ(run.stamp_s[i], static_cast<double>(i) * (1.0 / rate_hz));
    }
}

// Lengths of the runs of lost samples.
std::vector<std::size_t> bursts_of(const std::vector<bool>& lost) {
    std::vector<std::size_t> lengths;
    bool before = false;
    for (const bool is_lost : lost) {
        if (is_lost && !before) { lengths.push_back(0); }
        if (is_lost) { ++lengths.back(); }
        before = is_lost;
    }
    return lengths;
}

double chi_square_of_evenness(const std::vector<std::size_t>& counts) {
    double total = 0.0;
    for (const std::size_t count : counts) { total += static_cast<double>(count); }
    const double expected = total / static_cast<double>(counts.size());
    double sum = 0.0;
    for (const std::size_t count : counts) {
        sum += (static_cast<double>(count) - expected) * (static_cast<double>(count) - expected) / expected;
    }
    return sum;
}

TEST(Dropped, BurstsArePoissonInNumberAndEvenInLength) {
    // One in 500 samples: two bursts seldom meet.
    const SensorModel model = with_effect(ideal_model(), "dropped", {{"per_hour", 720.0}, {"longest", 8.0}});
    constexpr std::size_t blocks = 300;
    constexpr std::size_t seeds = 20;
    constexpr double expected = blocks * block_samples / 500.0;
    std::vector<std::size_t> lengths(8);
    double number = 0.0;
    double dispersion = 0.0;
    for (std::size_t seed = 1; seed <= seeds; ++seed) {
        std::vector<bool> lost;
        SensorSimulator simulator(model, rate_hz, seed);
        for (std::size_t i = 0; i < blocks; ++i) {
            const SampleBlock& block = simulator.next_block();
            lost.insert(lost.end(), block.lost.begin(), block.lost.end());
        }
        const auto bursts = bursts_of(lost);
        number += static_cast<double>(bursts.size());
        dispersion += std::pow(static_cast<double>(bursts.size()) - expected, 2) / expected;
        for (const std::size_t length : bursts) {
            if (length <= 8) { ++lengths[length - 1]; }
        }
    }
    // Bursts that meet are seen as one: a share of 4.5/500 less, and longer by as much.
    EXPECT_NEAR(number, seeds * expected * (1.0 - 4.5 / 500.0), 4.0 * std::sqrt(seeds * expected));
    EXPECT_LT(dispersion, chi_square_limit(seeds));
    EXPECT_LT(chi_square_of_evenness(lengths), chi_square_limit(7));
}

TEST(Dropped, InTheStampsTheOtherSamplesAreAsIfNothingWasLost) {
    const SensorModel plain = white_model(0.01);
    const Simulated whole = simulate(plain, rate_hz, 3, 10, clock_world());
    const Simulated holed =
        simulate(with_effect(plain, "dropped", {{"per_hour", 3600.0}}), rate_hz, 3, 10, clock_world());
    EXPECT_GT(bursts_of(holed.lost).size(), 50U);
    EXPECT_EQ(bursts_of(whole.lost).size(), 0U);
    EXPECT_EQ(holed.stamp_s, whole.stamp_s);
    EXPECT_EQ(holed.rate_rad_s, whole.rate_rad_s);
}

TEST(Dropped, HiddenFromTheStampsShiftsTheWorldByTheLostPeriods) {
    const std::map<std::string, double> shown = {{"per_hour", 3600.0}};
    const std::map<std::string, double> hidden = {{"per_hour", 3600.0}, {"in_stamps", 0.0}};
    const Simulated holed =
        simulate(with_effect(ideal_model(), "dropped", shown), rate_hz, 3, 10, clock_world());
    const Simulated closed =
        simulate(with_effect(ideal_model(), "dropped", hidden), rate_hz, 3, 5, clock_world());
    EXPECT_EQ(bursts_of(closed.lost).size(), 0U);
    std::size_t k = 0;  // the delivered samples of the one are all samples of the other
    for (std::size_t i = 0; i < holed.size() && k < closed.size(); ++i) {
        if (holed.lost[i]) { continue; }
        ASSERT_EQ(closed.stamp_s[k], static_cast<double>(k) * (1.0 / rate_hz));
        ASSERT_NEAR(closed.rate_rad_s[0][k], holed.rate_rad_s[0][i], 1e-12);
        ++k;
    }
    EXPECT_EQ(k, closed.size());
    EXPECT_GT(closed.rate_rad_s[0].back() - closed.stamp_s.back(), 0.5);
}

std::vector<std::size_t> repeats_of(const std::vector<double>& values) {
    std::vector<std::size_t> places;
    for (std::size_t i = 1; i < values.size(); ++i) {
        if (values[i] == values[i - 1]) { places.push_back(i); }
    }
    return places;
}

TEST(Stale, ItsShareOfTheSamplesRepeatsAtAnEvenBeatInAllThatTheSensorShows) {
    constexpr double eps = 0.0137;
    SensorModel model = with_effect(white_model(0.01), "stale", {{"eps", eps}});
    model.temp_noise_C = 0.1;
    constexpr std::size_t blocks = 100;
    const Simulated run = simulate(model, rate_hz, 5, blocks);
    const std::vector<std::size_t> repeats = repeats_of(run.rate_rad_s[0]);
    EXPECT_NEAR(static_cast<double>(repeats.size()), eps * blocks * block_samples, 1.0);
    for (std::size_t i = 1; i < repeats.size(); ++i) {
        // Every 1 / eps = 72.99 samples, to within one.
        ASSERT_NEAR(static_cast<double>(repeats[i] - repeats[i - 1]), 1.0 / eps, 1.0);
    }
    EXPECT_EQ(repeats_of(run.rate_rad_s[1]), repeats);
    EXPECT_EQ(repeats_of(run.rate_rad_s[2]), repeats);
    EXPECT_EQ(repeats_of(run.temperature_C), repeats);
}

// The number of runs in n samples is n eps / L, within some standard deviations of a Markov chain's count,
// which is below that of a Poisson variable.
TEST(Stale, RepeatsAtRandomInRunsOfTheirLength) {
    constexpr std::size_t blocks = 400;
    const auto n = static_cast<double>(blocks * block_samples);
    for (const auto& [eps, length] : {std::pair{0.05, 1.0}, std::pair{0.05, 3.0}, std::pair{0.4, 2.0}}) {
        const Simulated run =
            simulate(with_effect(white_model(0.01), "stale", {{"eps", eps}, {"run_length", length}}), rate_hz,
                     5, blocks);
        const std::vector<std::size_t> repeats = repeats_of(run.rate_rad_s[0]);
        double runs = 1.0;
        double next_but_one = 0.0;
        for (std::size_t i = 1; i < repeats.size(); ++i) {
            runs += repeats[i] - repeats[i - 1] > 1 ? 1.0 : 0.0;
            next_but_one += repeats[i] - repeats[i - 1] == 2 ? 1.0 : 0.0;
        }
        const double expected = n * eps / length;
        EXPECT_NEAR(runs, expected, 4.5 * std::sqrt(expected)) << eps << ' ' << length;
        EXPECT_NEAR(static_cast<double>(repeats.size()), n * eps, 4.5 * std::sqrt(2.0 * n * eps * length));
        // After a run, one fresh sample and a run again: as often as one begins.
        const double begins = eps / length / (1.0 - eps);
        EXPECT_NEAR(next_but_one, expected * begins, 4.5 * std::sqrt(expected * begins) + 1.0);
        EXPECT_EQ(repeats_of(run.temperature_C), repeats);
    }
}

// The x axis shows the moment of the world.
TEST(Stale, ShowsTheWorldAsOfEvenUpdates) {
    constexpr double eps = 0.3;
    const double update_s = 1.0 / (rate_hz * (1.0 - eps));
    const Simulated run =
        simulate(with_effect(ideal_model(), "stale", {{"eps", eps}}), rate_hz, 1, 4, clock_world());
    std::size_t repeats = 0;
    for (std::size_t i = 1; i < run.size(); ++i) {
        const double age_s = static_cast<double>(i) / rate_hz - run.rate_rad_s[0][i];
        ASSERT_GE(age_s, -1e-9) << i;
        ASSERT_LT(age_s, update_s + 1e-9) << i;
        const double step_s = run.rate_rad_s[0][i] - run.rate_rad_s[0][i - 1];
        if (step_s == 0.0) {
            ++repeats;
        } else {
            ASSERT_NEAR(step_s, update_s, 1e-9) << i;
        }
    }
    EXPECT_NEAR(static_cast<double>(repeats), eps * static_cast<double>(run.size()), 2.0);
}

// Only what holds of all axes is the sensor's own; what repeats at random was read twice.
TEST(Stale, ShowsTheWorldAsOfTheSampleWhereItIsNoBeatOfTheSensors) {
    const SensorModel one = with_effect(ideal_model(), "stale", {{"eps", 0.3}}, {"y"});
    const SensorModel random = with_effect(ideal_model(), "stale", {{"eps", 0.3}, {"run_length", 2.0}});
    for (const SensorModel& model : {one, random}) {
        SensorSimulator simulator(model, rate_hz, 1, clock_world());
        const SampleBlock& block = simulator.next_block();
        for (std::size_t i = 0; i < block_samples; ++i) {
            ASSERT_EQ(block.world_s[i], static_cast<double>(i) * (1.0 / rate_hz));
        }
    }
}

TEST(Stale, ItsPhaseIsAnyFromSeedToSeed) {
    constexpr double eps = 0.1;
    std::vector<std::size_t> first_at(10);
    for (unsigned seed = 1; seed <= 500; ++seed) {
        SensorSimulator simulator(with_effect(white_model(0.01), "stale", {{"eps", eps}}, {"y"}), rate_hz,
                                  seed);
        const BlockValues& rate = simulator.next_block().rate_rad_s[1];
        ++first_at[repeats_of({rate.begin(), rate.end()}).front() - 1];
    }
    EXPECT_LT(chi_square_of_evenness(first_at), chi_square_limit(9));
}

TEST(Quantization, RatesLieOnItsGridWithTheErrorOfRounding) {
    constexpr double lsb = 0.122 * rad_per_deg;
    const SensorModel plain = white_model(0.1);
    const Simulated fine = simulate(plain, rate_hz, 1, 20);
    const Simulated coarse =
        simulate(with_effect(plain, "quantization", {{"lsb_dps", 0.122}}), rate_hz, 1, 20);
    double squares = 0.0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
        const double steps = coarse.rate_rad_s[0][i] / lsb;
        ASSERT_NEAR(steps, std::round(steps), 1e-9);
        const double error = coarse.rate_rad_s[0][i] - fine.rate_rad_s[0][i];
        ASSERT_LE(std::fabs(error), 0.5 * lsb * (1.0 + 1e-9));
        squares += error * error;
    }
    const auto n = static_cast<double>(fine.size());
    EXPECT_NEAR(squares / n / (lsb * lsb / 12.0), 1.0, 4.0 * std::sqrt(0.8 / n));
}

// The model's own step follows only where the coarser one is made of it.
TEST(Quantization, StepThatIsNoMultipleTakesTheModelsPlace) {
    SensorModel model = white_model(0.01);
    model.lsb_rad_s = 0.01 * rad_per_deg;
    model.saturation_rad_s = 500.0 * rad_per_deg;
    for (const double lsb_dps : {0.03, 0.025}) {
        const SensorModel coarse = with_effect(model, "quantization", {{"lsb_dps", lsb_dps}}, {"y"});
        const bool is_multiple = lsb_dps == 0.03;
        EXPECT_EQ(converter_step_rad_s(coarse, 0), model.lsb_rad_s);
        EXPECT_DOUBLE_EQ(converter_step_rad_s(coarse, 1), (is_multiple ? 0.01 : lsb_dps) * rad_per_deg);
        const Simulated run = simulate(coarse, rate_hz, 1, 2);
        for (const double rate_rad_s : run.rate_rad_s[1]) {
            const double steps = rate_rad_s / (lsb_dps * rad_per_deg);
            ASSERT_NEAR(steps, std::round(steps), 1e-6) << lsb_dps;
        }
    }
}

TEST(Quantization, RoundsHalfAwayFromZero) {
    SensorModel model = with_effect(ideal_model(), "quantization", {{"lsb_dps", deg_per_rad}});  // 1 rad/s
    model.axes[0].bias_rad_s = 0.5;
    model.axes[1].bias_rad_s = -2.5;
    model.axes[2].bias_rad_s = 1.49;
    const Simulated run = simulate(model, rate_hz, 1, 1);
    EXPECT_NEAR(run.rate_rad_s[0][0], 1.0, 1e-12);
    EXPECT_NEAR(run.rate_rad_s[1][0], -3.0, 1e-12);
    EXPECT_NEAR(run.rate_rad_s[2][0], 1.0, 1e-12);
}

TEST(Saturation, WhatLiesBeyondPilesUpAtTheLimit) {
    // White noise of standard deviation 1 rad/s, cut at 1 rad/s: 15.866 % at each end.
    const SensorModel model =
        with_effect(white_model(0.1), "saturation", {{"limit_dps", deg_per_rad}}, {"x"});
    const Simulated run = simulate(model, rate_hz, 1, 40);
    const double limit = *std::max_element(run.rate_rad_s[0].begin(), run.rate_rad_s[0].end());
    EXPECT_NEAR(limit, 1.0, 1e-12);
    const auto n = static_cast<double>(run.size());
    const double share = 0.5 * std::erfc(std::sqrt(0.5));
    const double sd = std::sqrt(n * share * (1.0 - share));
    EXPECT_NEAR(static_cast<double>(std::ranges::count(run.rate_rad_s[0], limit)), n * share, 4.0 * sd);
    EXPECT_NEAR(static_cast<double>(std::ranges::count(run.rate_rad_s[0], -limit)), n * share, 4.0 * sd);
    EXPECT_GT(*std::max_element(run.rate_rad_s[1].begin(), run.rate_rad_s[1].end()), 2.0);
}

TEST(Spikes, ComeAsPoissonEventsOfEvenSizesOnEachAxisItsOwn) {
    const SensorModel model = with_effect(
        ideal_model(), "spikes", {{"per_hour", 3600.0}, {"smallest_dps", 2.0}, {"largest_dps", 4.0}});
    constexpr std::size_t blocks = 100;
    constexpr double expected = blocks * block_samples / rate_hz;
    std::vector<std::size_t> sizes(16);  // from -4 to -2 and from 2 to 4
    std::size_t together = 0;
    double number = 0.0;
    double dispersion = 0.0;
    constexpr int seeds = 10;
    for (int seed = 1; seed <= seeds; ++seed) {
        const Simulated run = simulate(model, rate_hz, static_cast<std::uint64_t>(seed), blocks);
        for (const auto& axis : run.rate_rad_s) {
            const auto n =
                static_cast<double>(axis.size()) - static_cast<double>(std::ranges::count(axis, 0.0));
            number += n;
            dispersion += (n - expected) * (n - expected) / expected;
        }
        for (std::size_t i = 0; i < run.size(); ++i) {
            if (run.rate_rad_s[0][i] != 0.0 && run.rate_rad_s[1][i] != 0.0) { ++together; }
            const double size_dps = run.rate_rad_s[0][i] * deg_per_rad;
            const double place = std::fabs(size_dps) - 2.0;
            if (place < 0.0 || place >= 2.0) { continue; }  // none, or two in one sample
            ++sizes[static_cast<std::size_t>(place * 4.0) + (size_dps < 0.0 ? 8U : 0U)];
        }
    }
    // Two in one sample are one: half a percent at a mean of 0.01.
    EXPECT_NEAR(number, 3.0 * seeds * expected * 0.995, 4.0 * std::sqrt(3.0 * seeds * expected));
    EXPECT_LT(dispersion, chi_square_limit(3.0 * seeds));
    EXPECT_LT(chi_square_of_evenness(sizes), chi_square_limit(15));
    const double expected_together = seeds * expected / 100.0;
    EXPECT_NEAR(static_cast<double>(together), expected_together, 4.0 * std::sqrt(expected_together));
}

TEST(Spikes, StayWithinTheConvertersRange) {
    SensorModel model = with_effect(ideal_model(), "spikes",
                                    {{"per_hour", 36000.0}, {"smallest_dps", 900.0}, {"largest_dps", 900.0}});
    model.lsb_rad_s = 0.01;
    model.saturation_rad_s = 1.0;
    SensorSimulator simulator(model, rate_hz, 1);
    const auto& counts = simulator.next_block().counts[0];
    EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), 100);
    EXPECT_EQ(*std::min_element(counts.begin(), counts.end()), -101);
}

TEST(NoEvents, OfARateOfZeroHappen) {
    SensorModel model = with_effect(ideal_model(), "spikes",
                                    {{"per_hour", 0.0}, {"smallest_dps", 1.0}, {"largest_dps", 1.0}});
    model.effects.push_back(effect_entry("dropped", {{"per_hour", 0.0}}));
    const Simulated run = simulate(model, rate_hz, 1, 10);
    EXPECT_EQ(bursts_of(run.lost).size(), 0U);
    EXPECT_EQ(std::ranges::count(run.rate_rad_s[0], 0.0), static_cast<std::ptrdiff_t>(run.size()));
}

std::uint64_t fnv1a(std::uint64_t hash, const void* bytes, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
        hash = (hash ^ static_cast<const unsigned char*>(bytes)[i]) * 0x100000001B3U;
    }
    return hash;
}

TEST(MotionAndSamplingEffects, TogetherGiveTheSameBitsOnEveryMachine) {
    SensorModel model = typical_mpu9250();
    for (AxisModel& axis : model.axes) { axis.noise.B_rad_per_s = 0.0; }  // held by its own tests
    model.effects = {
        effect_entry("scale_factor", {{"eps", 0.01}}),
        effect_entry("misalignment", {{"from_x", 0.01}, {"from_y", -0.02}}),
        effect_entry("nonlinearity", {{"quadratic", 1e-3}, {"cubic", -1e-3}}),
        effect_entry("asymmetry", {{"gain", 0.002}}),
        effect_entry("dead_zone", {{"width_dps", 0.3}, {"jump", 0.5}}),
        effect_entry("g_sensitivity", {{"x_dps_per_g", 0.1}, {"z_dps_per_g", -0.1}}),
        effect_entry("vibration_rectification", {{"y_dps_per_g2", 0.01}}),
        effect_entry("temp_scale", {{"per_C", 2e-4}}),
        effect_entry("latency", {{"delay_s", 0.003}}),
        effect_entry("clock_rate", {{"rel", -0.005}}),
        effect_entry("clock_jitter", {{"sd_s", 1e-4}, {"in_stamps", 0.0}}),
        effect_entry("dropped", {{"per_hour", 1000.0}}),
        effect_entry("lowpass", {{"fc_hz", 20.0}}, {"x", "y"}),
        effect_entry("lowpass", {{"fc_hz", 41.0}, {"order", 1.0}}, {"z"}),
        effect_entry("saturation", {{"limit_dps", 300.0}}),
        effect_entry("quantization", {{"lsb_dps", 2.0 / 65.5}}, {"y"}),
        effect_entry("spikes", {{"per_hour", 3600.0}, {"smallest_dps", 1.0}, {"largest_dps", 5.0}}),
        effect_entry("stale", {{"eps", 0.01}}),
    };
    ASSERT_EQ(simulation_refusal(model), std::nullopt);
    auto world = tumbling_world(350.0 * rad_per_deg);
    world->specific_force_m_s2 = [](double t_s) {
        return Vector3{9.0 * triangle(t_s / 5.0), 8.0 * triangle(t_s / 7.0), 9.80665};
    };
    SensorSimulator simulator(model, 100.0, 11, world);
    std::uint64_t hash = 0xCBF29CE484222325U;
    for (int i = 0; i < 16; ++i) {
        const SampleBlock& block = simulator.next_block();
        for (const auto& counts : block.counts) { hash = fnv1a(hash, counts.data(), sizeof counts); }
        for (const auto* reals : {&block.stamp_s, &block.world_s, &block.temperature_C}) {
            hash = fnv1a(hash, reals->data(), sizeof *reals);
        }
        hash = fnv1a(hash, block.lost.data(), sizeof block.lost);
    }
    EXPECT_EQ(hash, 0x3EB1F974D7D2E55BU);
}

}  // namespace
}  // namespace gyrolog
