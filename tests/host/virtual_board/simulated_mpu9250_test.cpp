#include "host/virtual_board/simulated_mpu9250.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/noise/likelihood_fit.hpp"
#include "firmware_protocol/device/mpu9250.h"

namespace gyrolog {
namespace {

class Mpu9250 : public testing::Test {
protected:
    std::uint8_t read(std::uint8_t address) {
        std::uint8_t value = 0;
        chip.read(address, {&value, 1});
        return value;
    }
    unsigned fifo_count() {
        std::array<std::uint8_t, 2> bytes{};
        chip.read(glp_mpu_fifo_counth, bytes);
        return bytes[0] * 256U + bytes[1];
    }
    void set(std::uint8_t address, std::uint8_t value) { chip.write(address, value, now_ns); }
    void start(std::uint8_t fifo_en) {
        set(glp_mpu_config, 3);  // 1 kHz inside
        set(glp_mpu_fifo_en, fifo_en);
        set(glp_mpu_user_ctrl, glp_mpu_user_ctrl_fifo_en | glp_mpu_user_ctrl_fifo_rst);
        set(glp_mpu_int_enable, glp_mpu_int_raw_rdy);
    }
    void take_samples(int count) {
        for (int i = 0; i < count; ++i) {
            now_ns = chip.next_instant_ns();
            EXPECT_TRUE(chip.pass_instant());
        }
    }

    std::int64_t now_ns = 0;
    SimulatedMpu9250 chip{typical_mpu9250(), 1, 0.0};
};

TEST_F(Mpu9250, IsAnMpu9250AndComesOutOfResetWithItsDefaults) {
    EXPECT_EQ(read(glp_mpu_who_am_i), 0x71);
    set(glp_mpu_who_am_i, 0);
    set(glp_mpu_smplrt_div, 9);
    EXPECT_EQ(read(glp_mpu_smplrt_div), 9);
    set(glp_mpu_pwr_mgmt_1, glp_mpu_pwr_mgmt_1_h_reset);
    EXPECT_EQ(read(glp_mpu_smplrt_div), 0);
    EXPECT_EQ(read(glp_mpu_pwr_mgmt_1), 0x01);
    EXPECT_EQ(read(glp_mpu_who_am_i), 0x71);
}

TEST_F(Mpu9250, RatesFollowTheFilterAndTheDivider) {
    set(glp_mpu_smplrt_div, 4);
    EXPECT_EQ(chip.nominal_rate_hz(), 8000.0);  // DLPF_CFG 0: the divider has no effect
    set(glp_mpu_config, 1);
    EXPECT_EQ(chip.nominal_rate_hz(), 200.0);
    set(glp_mpu_config, 7);
    EXPECT_EQ(chip.nominal_rate_hz(), 8000.0);
    set(glp_mpu_gyro_config, glp_mpu_gyro_fchoice_b_bypass);
    EXPECT_EQ(chip.nominal_rate_hz(), 32000.0);
}

// Where one has a filter and the other none, the fit is biased.
TEST(Mpu9250Filter, ActsWhereTheNoiseFitExpectsIt) {
    EXPECT_EQ(SimulatedMpu9250::widest_filter, LikelihoodFitOptions{}.filter_acts_below);
}

TEST_F(Mpu9250, IsSilentUntilSomethingWantsItsSamples) {
    EXPECT_EQ(chip.next_instant_ns(), SimulatedMpu9250::never_ns);
    start(0);
    EXPECT_EQ(chip.next_instant_ns(), 1'000'000);
    set(glp_mpu_pwr_mgmt_1, 0x41);  // sleep
    EXPECT_EQ(chip.next_instant_ns(), SimulatedMpu9250::never_ns);
}

TEST_F(Mpu9250, AFastClockBringsInstantsSooner) {
    SensorModel model = typical_mpu9250();
    model.timestamp_jitter_s = 0.0;
    chip = SimulatedMpu9250(model, 1, 0.01);
    start(0);
    take_samples(1010);
    EXPECT_EQ(now_ns, 1'000'000'000);
}

TEST_F(Mpu9250, TheFifoHoldsTheRegistersInTheirOrder) {
    start(glp_mpu_fifo_en_accel | glp_mpu_fifo_en_temp | glp_mpu_fifo_en_gyro);
    take_samples(1);
    ASSERT_EQ(fifo_count(), 14U);
    std::array<std::uint8_t, 14> from_fifo{};
    std::array<std::uint8_t, 14> from_registers{};
    chip.read(glp_mpu_fifo_r_w, from_fifo);
    chip.read(glp_mpu_accel_xout_h, from_registers);
    EXPECT_EQ(from_fifo, from_registers);
    EXPECT_EQ(fifo_count(), 0U);
    // At rest z shows gravity: 16384 counts at 2 g.
    EXPECT_NEAR(from_fifo[4] * 256 + from_fifo[5], 16384, 500);
    EXPECT_EQ(read(glp_mpu_fifo_r_w), 0xFF);  // empty
}

TEST_F(Mpu9250, AFullFifoKeepsTheOldestOrTheNewestAsConfigured) {
    for (const bool keep_oldest : {true, false}) {
        chip = SimulatedMpu9250(typical_mpu9250(), 1, 0.0);
        now_ns = 0;
        start(glp_mpu_fifo_en_gyro);
        set(glp_mpu_config, keep_oldest ? 0x43 : 0x03);
        take_samples(1);
        std::array<std::uint8_t, 6> first{};
        chip.read(glp_mpu_gyro_xout_h, first);
        take_samples(99);
        EXPECT_EQ(fifo_count(), 512U);
        EXPECT_NE(read(glp_mpu_int_status) & glp_mpu_int_fifo_oflow, 0);
        EXPECT_EQ(read(glp_mpu_int_status), 0);  // reading clears it
        std::array<std::uint8_t, 512> content{};
        chip.read(glp_mpu_fifo_r_w, content);
        std::array<std::uint8_t, 6> last{};
        chip.read(glp_mpu_gyro_xout_h, last);
        if (keep_oldest) {
            EXPECT_TRUE(std::equal(first.begin(), first.end(), content.begin()));
        } else {
            EXPECT_TRUE(std::equal(last.begin(), last.end(), content.end() - 6));
        }
    }
}

TEST_F(Mpu9250, InstantsScatterWithTheStampsButNeverLookLost) {
    SensorModel model = typical_mpu9250();
    model.timestamp_jitter_s = 2e-3;  // twice the period
    chip = SimulatedMpu9250(model, 1, 0.0);
    start(0);
    std::int64_t before_ns = 0;
    double shortest_ns = 1e9;
    double longest_ns = 0.0;
    for (int i = 0; i < 20'000; ++i) {
        take_samples(1);
        shortest_ns = std::min(shortest_ns, static_cast<double>(now_ns - before_ns));
        if (i > 0) { longest_ns = std::max(longest_ns, static_cast<double>(now_ns - before_ns)); }
        before_ns = now_ns;
    }
    EXPECT_EQ(shortest_ns, 0.51e6);
    EXPECT_EQ(longest_ns, 1.49e6);
    EXPECT_NEAR(static_cast<double>(now_ns), 20'000e6, 10.0 * 2e6);  // no drift
}

TEST_F(Mpu9250, AnotherRangeHoldsFromTheNextSampleOnAndSkipsNone) {
    const auto gyro_x = [&] {
        take_samples(1);
        std::array<std::uint8_t, 2> x{};
        chip.read(glp_mpu_gyro_xout_h, x);
        return static_cast<std::int16_t>(static_cast<std::uint16_t>(x[0] * 256U + x[1]));
    };
    SensorModel model = typical_mpu9250();
    model.axes[0].noise.N_rad_per_sqrt_s *= 100.0;  // 500 counts: no two samples are alike
    chip = SimulatedMpu9250(model, 1, 0.0);
    start(0);
    std::vector<double> unchanged_dps;
    for (int i = 0; i < 8; ++i) { unchanged_dps.push_back(gyro_x() / 131.0); }
    chip = SimulatedMpu9250(model, 1, 0.0);
    now_ns = 0;
    start(0);
    for (int i = 0; i < 8; ++i) {
        if (i == 4) { set(glp_mpu_gyro_config, 3U << glp_mpu_gyro_fs_sel_shift); }
        EXPECT_NEAR(gyro_x() / (i < 4 ? 131.0 : 16.4), unchanged_dps[static_cast<std::size_t>(i)],
                    0.51 / 16.4);
    }
}

// Counts of `samples` at 1 kHz / (1 + divider): gyro x and accelerometer x.
class FilteredMpu9250 : public Mpu9250 {
protected:
    struct Counts {
        std::vector<int> gyro;
        std::vector<int> accel;
        bool operator==(const Counts&) const = default;
    };
    Counts take(std::uint8_t config, std::uint8_t accel_config2, std::uint8_t divider, int samples) {
        set(glp_mpu_int_enable, 0);
        set(glp_mpu_config, config);
        set(glp_mpu_accel_config2, accel_config2);
        set(glp_mpu_smplrt_div, divider);
        set(glp_mpu_int_enable, glp_mpu_int_raw_rdy);
        Counts counts;
        for (int i = 0; i < samples; ++i) {
            take_samples(1);
            counts.gyro.push_back(count_at(glp_mpu_gyro_xout_h));
            counts.accel.push_back(count_at(glp_mpu_accel_xout_h));
        }
        return counts;
    }
    Counts taken_anew(std::uint8_t config, std::uint8_t accel_config2, std::uint8_t divider, int samples) {
        chip = SimulatedMpu9250(model, 1, 0.0);
        now_ns = 0;
        return take(config, accel_config2, divider, samples);
    }
    int count_at(std::uint8_t address) {
        std::array<std::uint8_t, 2> bytes{};
        chip.read(address, bytes);
        return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[0] * 256U + bytes[1]));
    }
    static double variance(const std::vector<int>& counts) {
        double mean = 0.0;
        double square = 0.0;
        for (const int count : counts) { mean += count / static_cast<double>(counts.size()); }
        for (const int count : counts) {
            square += (count - mean) * (count - mean) / static_cast<double>(counts.size());
        }
        return square;
    }

    SensorModel model = [] {
        SensorModel white = typical_mpu9250();
        for (AxisModel& axis : white.axes) { axis.noise = {.N_rad_per_sqrt_s = 0.1 * rad_per_deg}; }
        white.acc_noise_m_s2 *= 10.0;
        return white;
    }();
};

// White noise of density N^2 has the variance N^2 rate; behind the filter, N^2 pi f / sqrt 2.
TEST_F(FilteredMpu9250, TheFilterTakesAsMuchOfTheNoiseAsItsBandwidthSays) {
    constexpr int samples = 100'000;
    const Counts wide = taken_anew(3, 3, 9, samples);  // 41 Hz at 100 Hz: it does not act
    for (const auto& [config, bandwidth_hz] : {std::pair{6, 5.0}, std::pair{5, 10.0}, std::pair{4, 20.0}}) {
        const auto setting = static_cast<std::uint8_t>(config);
        const Counts narrow = taken_anew(setting, setting, 9, samples);
        const double expected = pi * bandwidth_hz / std::sqrt(2.0) / 100.0;
        EXPECT_NEAR(variance(narrow.gyro) / variance(wide.gyro), expected, 0.06 * expected) << bandwidth_hz;
        EXPECT_NEAR(variance(narrow.accel) / variance(wide.accel), expected, 0.06 * expected) << bandwidth_hz;
    }
}

TEST_F(FilteredMpu9250, AFilterFarAboveTheBandLeavesEveryCount) {
    const Counts counts = taken_anew(3, 3, 9, 2000);
    EXPECT_EQ(taken_anew(2, 2, 9, 2000), counts);
    EXPECT_EQ(taken_anew(1, 1, 9, 2000), counts);
    EXPECT_NE(taken_anew(4, 4, 9, 2000).gyro, counts.gyro);
}

TEST_F(FilteredMpu9250, AnotherFilterAtTheSameRateActsFromTheNextStartOn) {
    const double wide = variance(taken_anew(3, 3, 9, 20'000).gyro);
    EXPECT_LT(variance(take(6, 6, 9, 20'000).gyro), 0.2 * wide);
    EXPECT_NEAR(variance(take(3, 3, 9, 20'000).gyro), wide, 0.1 * wide);
}

TEST_F(FilteredMpu9250, TheModelsOwnFilterActsToo) {
    model.effects.push_back({"lowpass", {}, {{"fc_hz", 5.0}}, {}});
    const double once = variance(taken_anew(3, 3, 9, 50'000).gyro);
    const double twice = variance(taken_anew(6, 3, 9, 50'000).gyro);
    // integral of 1 / (1 + f^4)^2 over that of 1 / (1 + f^4): 3 / 4
    EXPECT_NEAR(twice / once, 0.75, 0.06);
}

TEST_F(Mpu9250, GravityLiesAlongTheAxisThatTheOrientationTurnsUpward) {
    SensorModel model = typical_mpu9250();
    model.orientation = Matrix3{{{0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}}};  // x points down
    chip = SimulatedMpu9250(model, 1, 0.0);
    start(0);
    take_samples(1);
    std::array<std::uint8_t, 6> bytes{};
    chip.read(glp_mpu_accel_xout_h, bytes);
    const auto accel = [&](std::size_t axis) {
        return static_cast<std::int16_t>(
            static_cast<std::uint16_t>(bytes[2 * axis] * 256U + bytes[2 * axis + 1]));
    };
    EXPECT_NEAR(accel(0), -16384, 500);  // at 2 g
    EXPECT_NEAR(accel(1), 0, 500);
    EXPECT_NEAR(accel(2), 0, 500);
}

TEST_F(Mpu9250, TheFullScaleSetsTheCounts) {
    SensorModel model = typical_mpu9250();
    for (AxisModel& axis : model.axes) {
        axis.noise = {};
        axis.bias_rad_s = 100.0 * rad_per_deg;
    }
    chip = SimulatedMpu9250(model, 1, 0.0);
    start(0);
    constexpr std::array lsb_per_dps{131.0, 65.5, 32.8, 16.4};  // PS-MPU-9250A-01, table 1
    for (unsigned range = 0; range < 4; ++range) {
        set(glp_mpu_gyro_config, static_cast<std::uint8_t>(range << glp_mpu_gyro_fs_sel_shift));
        take_samples(1);
        std::array<std::uint8_t, 2> x{};
        chip.read(glp_mpu_gyro_xout_h, x);
        EXPECT_NEAR(x[0] * 256 + x[1], 100.0 * lsb_per_dps[range], 0.5);
    }
}

}  // namespace
}  // namespace gyrolog
