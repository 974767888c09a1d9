#include "tools/vhci_board/usbip.hpp"

#include <cerrno>
#include <initializer_list>

#include <gtest/gtest.h>

namespace gyrolog::usbip {
namespace {

Bytes words(std::initializer_list<std::uint32_t> values) {
    Bytes bytes;
    for (const std::uint32_t value : values) {
        for (const unsigned shift : {24U, 16U, 8U, 0U}) {
            bytes.push_back(static_cast<std::uint8_t>(value >> shift));
        }
    }
    return bytes;
}

// The exchange printed in the kernel's "USB/IP protocol", section Example.
Bytes published_interrupt_in() {
    return words({0x00000001, 0x00000d05, 0x0001000f, 0x00000001, 0x00000001, 0x00000200, 0x00000040,
                  0xffffffff, 0x00000000, 0x00000004, 0x00000000, 0x00000000});
}

Bytes published_interrupt_out() {
    Bytes bytes = words({0x00000001, 0x00000d06, 0x0001000f, 0x00000000, 0x00000001, 0x00000000, 0x00000040,
                         0xffffffff, 0x00000000, 0x00000004, 0x00000000, 0x00000000});
    const Bytes data = words({0xffffffff, 0x860008a7, 0x84ce5ae2, 0x12376300});
    bytes.insert(bytes.end(), data.begin(), data.end());
    bytes.resize(header_bytes + 0x40);
    return bytes;
}

std::optional<Command> next(CommandReader& reader) {
    auto command = reader.next();
    EXPECT_TRUE(command.ok()) << command.error().message;
    return command.ok() ? *command : std::nullopt;
}

TEST(UsbIp, ReadsThePublishedExchange) {
    CommandReader reader;
    reader.append(published_interrupt_in());
    reader.append(published_interrupt_out());

    const auto first = next(reader);
    ASSERT_TRUE(first && std::holds_alternative<Submit>(*first));
    const Submit& in = std::get<Submit>(*first);
    EXPECT_EQ(in.sequence, 0xd05U);
    EXPECT_TRUE(in.in);
    EXPECT_EQ(in.endpoint, 1);
    EXPECT_EQ(in.requested_bytes, 64U);
    EXPECT_TRUE(in.data.empty());

    const auto second = next(reader);
    ASSERT_TRUE(second && std::holds_alternative<Submit>(*second));
    const Submit& out = std::get<Submit>(*second);
    EXPECT_EQ(out.sequence, 0xd06U);
    EXPECT_FALSE(out.in);
    ASSERT_EQ(out.data.size(), 64U);
    EXPECT_EQ(out.data[4], 0x86);
    EXPECT_EQ(out.data[14], 0x63);

    EXPECT_FALSE(next(reader));
}

TEST(UsbIp, AnswersLikeThePublishedExchange) {
    // The published replies hold 0xffffffff as start frame, which has a meaning for isochronous transfers
    // only.
    const Bytes published = words({0x00000003, 0x00000d06, 0, 0, 0, 0, 0x00000040, 0xffffffff, 0, 0, 0, 0});
    Bytes reply;
    append_submit_reply(reply, 0xd06, 0, 64, {});
    ASSERT_EQ(reply.size(), published.size());
    for (std::size_t at = 0; at < reply.size(); ++at) {
        if (at / 4 != 7) { EXPECT_EQ(reply[at], published[at]) << "byte " << at; }
    }
}

TEST(UsbIp, ReadsTheSameCommandsHoweverTheStreamIsCut) {
    Bytes stream = published_interrupt_out();
    const Bytes unlink = words({2, 0xd07, 0x0001000f, 0, 0, 0xd05, 0, 0, 0, 0, 0, 0});
    stream.insert(stream.end(), unlink.begin(), unlink.end());
    for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
        CommandReader reader;
        std::size_t commands = 0;
        for (const ByteView part : {ByteView(stream).first(cut), ByteView(stream).subspan(cut)}) {
            reader.append(part);
            while (const auto command = next(reader)) {
                ++commands;
                EXPECT_EQ(std::holds_alternative<Unlink>(*command), commands == 2) << "cut at " << cut;
                if (const auto* given_up = std::get_if<Unlink>(&*command)) {
                    EXPECT_EQ(given_up->target, 0xd05U);
                }
            }
        }
        EXPECT_EQ(commands, 2U) << "cut at " << cut;
    }
}

TEST(UsbIp, KeepsTheSetupPacketOfAControlTransferInWireOrder) {
    CommandReader reader;
    reader.append(words({1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0x21220100, 0x00000000}));
    const auto command = next(reader);
    ASSERT_TRUE(command);
    const std::array<std::uint8_t, 8> set_line_state = {0x21, 0x22, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00};
    EXPECT_EQ(std::get<Submit>(*command).setup, set_line_state);
}

TEST(UsbIp, WritesAnErrorAsANegativeErrnoInNetworkOrder) {
    Bytes reply;
    append_unlink_reply(reply, 9, -ECONNRESET);
    EXPECT_EQ(reply, words({4, 9, 0, 0, 0, 0xffffff98, 0, 0, 0, 0, 0, 0}));
}

TEST(UsbIp, RefusesWhatItCannotFollow) {
    CommandReader unknown;
    unknown.append(words({5, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_FALSE(unknown.next().ok());

    CommandReader overlong;
    overlong.append(words({1, 1, 0, 0, 1, 0, transfer_bytes_max + 1, 0, 0, 0, 0, 0}));
    EXPECT_FALSE(overlong.next().ok());
}

}  // namespace
}  // namespace gyrolog::usbip
