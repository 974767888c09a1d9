#include "host/transport/source_uri.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gyrolog {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

TEST(SourceUri, EachKindIsUnderstood) {
    EXPECT_EQ(parse_source_uri("usb:")->kind, SourceUri::Kind::usb);
    EXPECT_EQ(parse_source_uri("usb:")->rest, "");
    EXPECT_EQ(parse_source_uri("usb:S1")->rest, "S1");
    EXPECT_EQ(parse_source_uri("tty:/dev/ttyACM0")->kind, SourceUri::Kind::tty);
    EXPECT_EQ(parse_source_uri("tty:/dev/ttyACM0")->rest, "/dev/ttyACM0");
    EXPECT_EQ(parse_source_uri("sim:")->kind, SourceUri::Kind::sim);
    EXPECT_EQ(parse_source_uri("replay:night.pcapng")->kind, SourceUri::Kind::replay);
}

TEST(SourceUri, APathMayHoldColonsAndCommas) {
    EXPECT_EQ(parse_source_uri("replay:a:b,c=d.pcapng")->rest, "a:b,c=d.pcapng");
}

TEST(SourceUri, ASerialPortMayHaveASpeed) {
    const auto uri = parse_source_uri("tty:/dev/serial/by-path/a:1,0,speed=921600");
    ASSERT_TRUE(uri.ok()) << uri.error().message;
    EXPECT_EQ(uri->rest, "/dev/serial/by-path/a:1,0");
    EXPECT_THAT(uri->options, ElementsAre(Pair("speed", "921600")));
    EXPECT_EQ(parse_source_uri("tty:/dev/a,speed=9,b")->rest, "/dev/a,speed=9,b");
    EXPECT_FALSE(parse_source_uri("tty:,speed=9600").ok());
}

TEST(SourceUri, SimulationOptionsKeepTheirOrder) {
    const auto uri = parse_source_uri("sim:rate=1000,seed=7,model=a=b.json,realtime=");
    ASSERT_TRUE(uri.ok()) << uri.error().message;
    EXPECT_THAT(uri->options, ElementsAre(Pair("rate", "1000"), Pair("seed", "7"), Pair("model", "a=b.json"),
                                          Pair("realtime", "")));
}

TEST(SourceUri, WhatIsNotUnderstoodIsRefusedWithTheFormsThatAre) {
    for (const char* text : {"", "usb", "/dev/ttyACM0", "serial:x", "tty:", "replay:", "sim:rate", "sim:=5",
                             "sim:rate=1,rate=2", "sim:rate=1,,seed=2"}) {
        const auto uri = parse_source_uri(text);
        ASSERT_FALSE(uri.ok()) << text;
        EXPECT_EQ(uri.error().code, ErrorCode::invalid_argument) << text;
        EXPECT_THAT(uri.error().message, HasSubstr("usb:SERIAL")) << text;
    }
}

}  // namespace
}  // namespace gyrolog
