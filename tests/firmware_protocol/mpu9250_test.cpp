#include <gtest/gtest.h>

#include "bench_board.hpp"

namespace gyrolog {
namespace {

constexpr glp_mpu_settings usual{100'000, 500, 8, 41, glp_layout_gyro | glp_layout_accel};

struct PlanCase {
    glp_mpu_settings settings;
    std::uint8_t smplrt_div, config, gyro_config, accel_config, accel_config2, fifo_en;
    std::uint16_t decimation;
};

// Register values worked out by hand from the register map's tables (registers 25 to 29 and 35). CONFIG has
// FIFO_MODE, 0x40, in it.
TEST(Mpu9250, PlansTheRegistersOfTheRegisterMap) {
    const PlanCase cases[] = {
        {{1'000'000, 250, 2, 184, 3}, 0, 0x41, 0x00, 0x00, 0x01, 0x78, 1},
        {{500'000, 500, 4, 92, 3}, 1, 0x42, 0x08, 0x08, 0x02, 0x78, 1},
        {{100'000, 1000, 8, 41, 1}, 9, 0x43, 0x10, 0x10, 0x03, 0x70, 1},
        {{50'000, 2000, 16, 20, 2}, 19, 0x44, 0x18, 0x18, 0x04, 0x08, 1},
        {{10'000, 250, 2, 10, 4}, 99, 0x45, 0x00, 0x00, 0x05, 0x80, 1},
        {{3'906, 250, 2, 5, 7}, 255, 0x46, 0x00, 0x00, 0x06, 0xF8, 1},
        {{333'333, 250, 2, 5, 7}, 2, 0x46, 0x00, 0x00, 0x06, 0xF8, 1},
        {{8'000'000, 250, 2, 250, 3}, 0, 0x40, 0x00, 0x00, 0x00, 0x78, 1},
        {{8'000'000, 250, 2, 3600, 3}, 0, 0x47, 0x00, 0x00, 0x07, 0x78, 1},
        {{100'000, 250, 2, 250, 3}, 0, 0x40, 0x00, 0x00, 0x00, 0x00, 80},
        {{32'000'000, 2000, 16, GLP_DLPF_OFF, 1}, 0, 0x40, 0x19, 0x18, 0x08, 0x70, 1},
        {{100'000, 2000, 16, GLP_DLPF_OFF, 3}, 0, 0x40, 0x19, 0x18, 0x08, 0x00, 320},
        {{3'906, 2000, 16, GLP_DLPF_OFF, 3}, 0, 0x40, 0x19, 0x18, 0x08, 0x00, 8192},
    };
    for (const PlanCase& wanted : cases) {
        SCOPED_TRACE(std::to_string(wanted.settings.rate_mHz) + " mHz, " +
                     std::to_string(wanted.settings.dlpf_hz));
        glp_mpu_plan plan{};
        ASSERT_TRUE(glp_mpu_plan_for(&wanted.settings, &plan));
        EXPECT_EQ(plan.smplrt_div, wanted.smplrt_div);
        EXPECT_EQ(plan.config, wanted.config);
        EXPECT_EQ(plan.gyro_config, wanted.gyro_config);
        EXPECT_EQ(plan.accel_config, wanted.accel_config);
        EXPECT_EQ(plan.accel_config2, wanted.accel_config2);
        EXPECT_EQ(plan.fifo_en, wanted.fifo_en);
        EXPECT_EQ(plan.decimation, wanted.decimation);
        EXPECT_EQ(plan.fifo, wanted.decimation == 1);
    }
}

TEST(Mpu9250, HasNoRateRangeFilterOrLayoutBesideThoseOfTheRegisterMap) {
    const glp_mpu_settings refused[] = {
        {0, 500, 8, 41, 3},          {1'000'001, 500, 8, 41, 3},      {999'999, 500, 8, 41, 3},
        {3'905, 500, 8, 41, 3},      {700'000, 500, 8, 41, 3},        {8'000'000, 500, 8, 184, 3},
        {9'000'000, 500, 8, 250, 3}, {100'000, 0, 8, 41, 3},          {100'000, 4000, 8, 41, 3},
        {100'000, 500, 32, 41, 3},   {100'000, 500, 8, 42, 3},        {100'000, 500, 8, 0, 3},
        {100'000, 500, 8, 41, 0},    {100'000, 500, 8, 41, 8},        {64'000'000, 500, 8, GLP_DLPF_OFF, 3},
        {3'905, 500, 8, 250, 3},     {3'905, 500, 8, GLP_DLPF_OFF, 3}};
    for (const glp_mpu_settings& settings : refused) {
        glp_mpu_plan plan{};
        EXPECT_FALSE(glp_mpu_plan_for(&settings, &plan)) << settings.rate_mHz << " mHz " << settings.dlpf_hz;
    }
}

TEST(Mpu9250, TellsTheScalesOfTheProductSpecification) {
    // PS-MPU-9250A-01 tables 1 and 2: LSB/(deg/s) rounded to three digits, LSB/g exact.
    struct Scale {
        std::uint16_t dps;
        double lsb_per_dps;
        std::uint16_t g;
        double lsb_per_g;
    };
    for (const Scale& scale : {Scale{250, 131, 2, 16384}, Scale{500, 65.5, 4, 8192},
                               Scale{1000, 32.8, 8, 4096}, Scale{2000, 16.4, 16, 2048}}) {
        glp_mpu_settings settings = usual;
        settings.gyro_full_scale_dps = scale.dps;
        settings.accel_full_scale_g = scale.g;
        glp_mpu_plan plan{};
        ASSERT_TRUE(glp_mpu_plan_for(&settings, &plan));
        glp_config config{};
        glp_mpu_describe(&settings, &plan, &config);
        EXPECT_NEAR(config.gyro_ndps_per_lsb, 1e9 / scale.lsb_per_dps, 0.5);
        EXPECT_NEAR(config.accel_pg_per_lsb, 1e12 / scale.lsb_per_g, 0.5);
        EXPECT_NEAR(1e9 / config.temp_nC_per_lsb, 333.87, 1e-4);
        EXPECT_EQ(config.temp_offset_mC, 21'000);
    }
}

TEST(Mpu9250, ArrangesEveryLayoutFromTheRegistersOrderToTheWires) {
    const std::uint8_t accel[] = {0x11, 0x12, 0x13, 0x14, 0x15, 0x16};
    const std::uint8_t temperature[] = {0x21, 0x22};
    const std::uint8_t gyro[] = {0x31, 0x32, 0x33, 0x34, 0x35, 0x36};
    for (std::uint8_t layout = 1; layout < 8; ++layout) {
        std::vector<std::uint8_t> record;
        std::vector<std::int16_t> wanted;
        if ((layout & glp_layout_accel) != 0) { record.insert(record.end(), accel, accel + 6); }
        if ((layout & glp_layout_temperature) != 0) {
            record.insert(record.end(), temperature, temperature + 2);
        }
        if ((layout & glp_layout_gyro) != 0) { record.insert(record.end(), gyro, gyro + 6); }
        if ((layout & glp_layout_gyro) != 0) { wanted.insert(wanted.end(), {0x3132, 0x3334, 0x3536}); }
        if ((layout & glp_layout_accel) != 0) { wanted.insert(wanted.end(), {0x1112, 0x1314, 0x1516}); }
        if ((layout & glp_layout_temperature) != 0) { wanted.insert(wanted.end(), {0x2122}); }
        ASSERT_EQ(record.size(), glp_sample_bytes(layout));

        std::vector<std::uint8_t> two = record;
        two.insert(two.end(), record.begin(), record.end());
        EXPECT_FALSE(glp_mpu_arrange(two.data(), 2, layout));
        glp_samples samples{};
        samples.layout = layout;
        samples.samples = two.data();
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t k = 0; k < wanted.size(); ++k) {
                EXPECT_EQ(glp_sample_field(&samples, i, k), wanted[k]);
            }
        }
    }
}

TEST(Mpu9250, SeesSaturationInGyroAndAccelerometerButNotInTemperature) {
    for (std::size_t field = 0; field < 7; ++field) {
        for (const unsigned count : {0x7FFFU, 0x8000U, 0x7FFEU, 0x8001U}) {
            std::vector<std::uint8_t> record(14);
            record[2 * field] = static_cast<std::uint8_t>(count >> 8U);
            record[2 * field + 1] = static_cast<std::uint8_t>(count);
            const bool at_the_end = count == 0x7FFF || count == 0x8000;
            EXPECT_EQ(glp_mpu_arrange(record.data(), 1, 7), at_the_end && field != 3)
                << field << ' ' << count;
        }
    }
}

TEST(Mpu9250, SetUpWritesTheClockTheFilterAndTheInterruptInTheRightOrder) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    using Writes = std::vector<std::pair<std::uint8_t, std::uint8_t>>;
    EXPECT_EQ(bench.sensor.writes, (Writes{{0x6B, 0x80},
                                           {0x6B, 0x01},
                                           {0x6A, 0x10},
                                           {0x6C, 0x00},  // reset, PLL, SPI
                                           {0x37, 0x00},  // pulses
                                           {0x19, 9},
                                           {0x1A, 0x43},
                                           {0x1B, 0x08},
                                           {0x1C, 0x10},
                                           {0x1D, 0x03},
                                           {0x23, 0x00},
                                           {0x38, 0x00},
                                           {0x6A, 0x10},
                                           {0x23, 0x78},
                                           {0x6A, 0x50},
                                           {0x38, 0x01},  // FIFO, then its interrupt
                                           {0x6A, 0x14},
                                           {0x6A, 0x50}}));  // and empty once more
}

TEST(Mpu9250, LeavesTheI2cInterfaceOnWhenTheBusIsI2c) {
    BenchBoard bench;
    glp_hal hal = *bench.board.hal;
    hal.sensor_on_spi = false;
    bench.board.hal = &hal;
    bench.boot_and_raise_dtr();
    for (const auto& [address, value] : bench.sensor.writes) {
        if (address == glp_mpu_user_ctrl) { EXPECT_EQ(value & glp_mpu_user_ctrl_i2c_if_dis, 0); }
    }
}

}  // namespace
}  // namespace gyrolog
