#include "host/virtual_board/sim_options.hpp"

#include <gtest/gtest.h>

#include "firmware_protocol/device/board.h"

namespace gyrolog {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

TEST(SimOptions, EveryOptionIsRead) {
    const auto options = parse_sim_options(Pairs{{"model", "a.json"},
                                                 {"rate", "333.333"},
                                                 {"full_scale", "2000"},
                                                 {"dlpf", "off"},
                                                 {"seed", "18446744073709551615"},
                                                 {"boards", "3"},
                                                 {"board", "2"},
                                                 {"realtime", "1"},
                                                 {"clock_ppm", "-250"},
                                                 {"fault", "fifo_overflow@12.5+link_stall@20..22.5"},
                                                 {"unplug", "90"},
                                                 {"endpoints", "fixed_kind"},
                                                 {"sensor", "mpu9255"}});
    ASSERT_TRUE(options.ok()) << options.error().message;
    EXPECT_EQ(options->model_path, "a.json");
    EXPECT_EQ(options->rate_hz, 333.333);
    EXPECT_EQ(options->full_scale_dps, 2000U);
    EXPECT_EQ(options->dlpf_hz, GLP_DLPF_OFF);
    EXPECT_EQ(options->seed, 18446744073709551615U);
    EXPECT_EQ(options->boards, 3U);
    EXPECT_EQ(options->board, 2U);
    EXPECT_TRUE(options->realtime);
    EXPECT_DOUBLE_EQ(*options->clock_error, -250e-6);
    ASSERT_EQ(options->faults.size(), 3U);
    EXPECT_EQ(options->faults[0].kind, BoardFault::Kind::fifo_overflow);
    EXPECT_EQ(options->faults[0].at_s, 12.5);
    EXPECT_EQ(options->faults[1].duration_s, 2.5);
    EXPECT_EQ(options->faults[2].kind, BoardFault::Kind::unplug);
    EXPECT_EQ(options->endpoints.in, 0x82);
    EXPECT_EQ(options->who_am_i, 0x73);
    EXPECT_EQ(options->text.find("board"), std::string::npos);
}

TEST(SimOptions, ACableThatIsPulledMayComeBack) {
    const auto options = parse_sim_options(
        Pairs{{"replug", "95"}, {"fault", "unplug@10..20.5"}, {"unplug", "90"}, {"self_powered", "1"}});
    ASSERT_TRUE(options.ok()) << options.error().message;
    ASSERT_EQ(options->faults.size(), 2U);
    EXPECT_EQ(options->faults[0].duration_s, 10.5);
    EXPECT_EQ(options->faults[1].at_s, 90.0);
    EXPECT_EQ(options->faults[1].duration_s, 5.0);
    EXPECT_TRUE(options->self_powered);
    EXPECT_FALSE(parse_sim_options(Pairs{{"unplug", "90"}, {"replug", "80"}}).ok());
    EXPECT_FALSE(parse_sim_options(Pairs{{"replug", "80"}}).ok());
}

TEST(SimOptions, AnUnknownOptionOrABadValueIsRefusedByName) {
    for (const auto& [key, value] : Pairs{{"speed", "1"},
                                          {"rate", "fast"},
                                          {"rate", "100x"},
                                          {"rate", "nan"},
                                          {"rate", "-1"},
                                          {"rate", ""},
                                          {"seed", "1.5"},
                                          {"boards", "0"},
                                          {"realtime", "yes"},
                                          {"clock_ppm", "20000"},
                                          {"ring", "10"},
                                          {"model", ""},
                                          {"fault", "fire@1"},
                                          {"fault", "reset"},
                                          {"fault", "reset@1+"},
                                          {"fault", "link_stall@1"},
                                          {"fault", "link_stall@3..1"},
                                          {"fault", "unplug@3..1"},
                                          {"self_powered", "yes"},
                                          {"endpoints", "any"},
                                          {"sensor", "icm20948"},
                                          {"unplug", "soon"}}) {
        const auto options = parse_sim_options(Pairs{{key, value}});
        ASSERT_FALSE(options.ok()) << key << "=" << value;
        EXPECT_EQ(options.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(options.error().message.find(key + "=" + value), std::string::npos)
            << options.error().message;
    }
}

}  // namespace
}  // namespace gyrolog
