#include <cstring>

#include <gtest/gtest.h>
#include <gyrolog_protocol/message.h>

#include "wire.hpp"

namespace gyrolog {
namespace {

glp_frame frame_of(std::uint8_t type, const std::uint8_t* payload, std::size_t size) {
    return {type, 0, 0, payload, size};
}

glp_config some_config() {
    glp_config config{};
    config.layout = 3;
    config.samples_per_frame = 4;
    config.rate_mHz = 100'000;
    config.decimation = 1;
    config.gyro_ndps_per_lsb = 1;
    config.accel_pg_per_lsb = 1;
    config.temp_nC_per_lsb = 1;
    config.temp_offset_mC = -273'150;
    return config;
}

TEST(Message, ASampleHasTheBytesOfItsLayout) {
    const std::size_t wanted[] = {0, 6, 6, 12, 2, 8, 8, 14, 0};
    for (std::uint8_t layout = 0; layout < 9; ++layout) {
        EXPECT_EQ(glp_sample_bytes(layout), wanted[layout]);
    }
    EXPECT_EQ(glp_samples_per_frame_max(1), 162U);
    EXPECT_EQ(glp_samples_per_frame_max(3), 81U);
    EXPECT_EQ(glp_samples_per_frame_max(4), 255U);
    EXPECT_EQ(glp_samples_per_frame_max(7), 69U);
    EXPECT_EQ(glp_samples_per_frame_max(8), 0U);
}

TEST(Message, NegativeFieldsKeepTheirSign) {
    const glp_config config = some_config();
    std::uint8_t payload[64];
    const std::size_t size = glp_config_write(&config, payload, sizeof payload);
    ASSERT_EQ(size, 40U);
    const glp_frame frame = frame_of(glp_frame_config, payload, size);
    glp_config back{};
    ASSERT_EQ(glp_config_read(&frame, &back), glp_status_ok);
    EXPECT_EQ(back.temp_offset_mC, -273'150);
}

TEST(Message, WritesNothingThatAReaderWouldRefuse) {
    std::uint8_t payload[GLP_FRAME_PAYLOAD_MAX];
    glp_config config = some_config();
    config.samples_per_frame = 82;
    EXPECT_EQ(glp_config_write(&config, payload, sizeof payload), 0U);
    glp_hello hello{};
    hello.protocol_major = 1;
    hello.tick_hz = 1;
    hello.tick_bits = 31;
    EXPECT_EQ(glp_hello_write(&hello, payload, sizeof payload), 0U);
    hello.tick_bits = 32;
    EXPECT_EQ(glp_hello_write(&hello, payload, sizeof payload), 72U);
    glp_samples samples{};
    samples.layout = 3;
    EXPECT_EQ(glp_samples_write(&samples, payload, sizeof payload), 0U);
    glp_event event{};
    event.text_bytes = GLP_EVENT_TEXT_MAX + 1;
    EXPECT_EQ(glp_event_write(&event, payload, sizeof payload), 0U);
}

TEST(Message, WritesNothingWhenItDoesNotFit) {
    std::uint8_t payload[128];
    const glp_config config = some_config();
    EXPECT_EQ(glp_config_write(&config, payload, 39), 0U);
    const glp_reply reply{1, 2, 3};
    EXPECT_EQ(glp_reply_write(&reply, payload, 7), 0U);
    const glp_configure configure{};
    EXPECT_EQ(glp_configure_write(&configure, payload, 15), 0U);
    const glp_device_status status{};
    EXPECT_EQ(glp_device_status_write(&status, payload, 47), 0U);
    glp_event event{};
    event.text = "abc";
    event.text_bytes = 3;
    EXPECT_EQ(glp_event_write(&event, payload, 26), 0U);
    EXPECT_EQ(glp_event_write(&event, payload, 27), 27U);
}

TEST(Message, TextIsCutAtItsFieldAndAlwaysTerminated) {
    glp_hello hello{};
    hello.protocol_major = 1;
    hello.tick_bits = 64;
    hello.tick_hz = 1;
    std::memset(hello.firmware, 'f', GLP_FIRMWARE_BYTES);
    std::memset(hello.sensor, 's', GLP_SENSOR_BYTES);
    std::uint8_t payload[72];
    ASSERT_EQ(glp_hello_write(&hello, payload, sizeof payload), 72U);
    const glp_frame frame = frame_of(glp_frame_hello, payload, sizeof payload);
    glp_hello back{};
    std::memset(&back, 0xEE, sizeof back);
    ASSERT_EQ(glp_hello_read(&frame, &back), glp_status_ok);
    EXPECT_EQ(std::string(back.firmware), std::string(24, 'f'));
    EXPECT_EQ(std::string(back.sensor), std::string(16, 's'));
}

TEST(Message, EveryStatusHasAName) {
    for (int status = 0; status < glp_status_count; ++status) {
        EXPECT_STRNE(glp_status_name(static_cast<glp_status>(status)), "unknown");
    }
}

}  // namespace
}  // namespace gyrolog
