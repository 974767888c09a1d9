#include "host/usb/cdc_descriptors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gyrolog {
namespace {

// A configuration as NXP's CDC example has it, one row a descriptor.
const Bytes cdc_configuration = {
    9, 2,    75,   0,    2,  1,  0, 0x80, 50,  // configuration 1, 75 bytes, two interfaces
    8, 11,   0,    2,    2,  2,  1, 0,         // interface association
    9, 4,    0,    0,    1,  2,  2, 1,    0,   // interface 0: communications, abstract control model
    5, 0x24, 0,    0x10, 1,                    // header
    5, 0x24, 1,    0,    1,                    // call management
    4, 0x24, 2,    2,                          // abstract control management
    5, 0x24, 6,    0,    1,                    // union: 0 controls 1
    7, 5,    0x82, 3,    10, 0,  9,            // interrupt IN
    9, 4,    1,    0,    2,  10, 0, 0,    0,   // interface 1: data
    7, 5,    0x81, 2,    64, 0,  0,            // bulk IN
    7, 5,    0x02, 2,    64, 0,  0,            // bulk OUT
};

constexpr std::size_t at_bulk_in = 61;
constexpr std::size_t at_bulk_out = 68;
constexpr std::size_t at_data_interface = 52;

Bytes changed(std::size_t at, std::uint8_t value) {
    Bytes copy = cdc_configuration;
    copy.at(at) = value;
    return copy;
}

ErrorCode refusal_of(const Bytes& configuration) {
    const auto parsed = parse_cdc_configuration(configuration);
    EXPECT_FALSE(parsed.ok());
    return parsed.ok() ? ErrorCode::failed : parsed.error().code;
}

TEST(CdcDescriptors, TheBoardsInterfacesAndEndpointsAreFound) {
    const auto layout = parse_cdc_configuration(cdc_configuration);
    ASSERT_TRUE(layout.ok()) << layout.error().message;
    EXPECT_EQ(layout->configuration, 1);
    EXPECT_EQ(layout->control_interface, 0);
    EXPECT_EQ(layout->data_interface, 1);
    EXPECT_EQ(layout->endpoint_in, 0x81);
    EXPECT_EQ(layout->endpoint_out, 0x02);
    EXPECT_EQ(layout->packet_in_bytes, 64);
    EXPECT_EQ(layout->packet_out_bytes, 64);
}

TEST(CdcDescriptors, TheUnionSaysWhichDataInterfaceBelongsToTheControl) {
    Bytes two = cdc_configuration;
    const Bytes foreign = {9, 4, 5,    0, 2,  10, 0, 0, 0,  // interface 5: somebody else's data
                           7, 5, 0x83, 2, 64, 0,  0, 7, 5, 0x03, 2, 64, 0, 0};
    two.insert(two.begin() + at_data_interface, foreign.begin(), foreign.end());
    two[2] = static_cast<std::uint8_t>(two.size());
    const auto layout = parse_cdc_configuration(two);
    ASSERT_TRUE(layout.ok()) << layout.error().message;
    EXPECT_EQ(layout->data_interface, 1);
    EXPECT_EQ(layout->endpoint_in, 0x81);
}

TEST(CdcDescriptors, SettingsThatAreNotInForceAreIgnored) {
    EXPECT_EQ(refusal_of(changed(at_data_interface + 3, 1)), ErrorCode::unsupported);
}

TEST(CdcDescriptors, AnythingButOneBulkEndpointEachWayIsUnsupported) {
    EXPECT_EQ(refusal_of(changed(at_bulk_in + 3, 3)), ErrorCode::unsupported) << "interrupt instead of bulk";
    EXPECT_EQ(refusal_of(changed(at_bulk_out + 2, 0x83)), ErrorCode::unsupported) << "two IN, no OUT";
    EXPECT_EQ(refusal_of(changed(at_data_interface + 5, 8)), ErrorCode::unsupported) << "mass storage";
    EXPECT_EQ(refusal_of(changed(17 + 6, 6)), ErrorCode::unsupported) << "an Ethernet function";
}

TEST(CdcDescriptors, PacketSizesThatUsbDoesNotHaveAreMalformed) {
    EXPECT_EQ(refusal_of(changed(at_bulk_in + 4, 0)), ErrorCode::malformed);
    EXPECT_EQ(refusal_of(changed(at_bulk_in + 4, 65)), ErrorCode::malformed);
    EXPECT_EQ(refusal_of(changed(at_bulk_out + 2, 0x00)), ErrorCode::malformed)
        << "endpoint 0 is the control pipe";
}

TEST(CdcDescriptors, EveryTruncationIsRefusedOrStillHasBothEndpoints) {
    for (std::size_t cut = 0; cut < cdc_configuration.size(); ++cut) {
        const Bytes prefix(cdc_configuration.begin(),
                           cdc_configuration.begin() + static_cast<std::ptrdiff_t>(cut));
        EXPECT_EQ(refusal_of(prefix), ErrorCode::malformed) << "cut at byte " << cut;
    }
}

TEST(CdcDescriptors, NoDamagedByteLeadsOutsideTheBytesOrToEndpointZero) {
    for (std::size_t at = 0; at < cdc_configuration.size(); ++at) {
        for (unsigned value = 0; value < 256; ++value) {
            // On the heap at its exact size: a sanitizer sees the first byte read too many.
            const Bytes damaged = changed(at, static_cast<std::uint8_t>(value));
            const auto layout = parse_cdc_configuration(damaged);
            if (!layout.ok()) { continue; }
            EXPECT_EQ(layout->endpoint_in & 0x80, 0x80);
            EXPECT_NE(layout->endpoint_in & 0x0F, 0);
            EXPECT_EQ(layout->endpoint_out & 0x80, 0);
            EXPECT_NE(layout->endpoint_out & 0x0F, 0);
            EXPECT_GE(layout->packet_in_bytes, 8);
        }
    }
}

TEST(CdcDescriptors, ADescriptorOfLengthZeroDoesNotStandStill) {
    EXPECT_EQ(refusal_of(changed(9, 0)), ErrorCode::malformed);
    EXPECT_EQ(refusal_of(changed(9, 1)), ErrorCode::malformed);
    EXPECT_EQ(refusal_of(changed(9, 255)), ErrorCode::malformed);
}

TEST(CdcDescriptors, TheConfigurationInForceIsTakenFromSeveral) {
    Bytes descriptors(device_descriptor_bytes, 0);
    Bytes second = cdc_configuration;
    second[5] = 2;
    descriptors.insert(descriptors.end(), cdc_configuration.begin(), cdc_configuration.end());
    descriptors.insert(descriptors.end(), second.begin(), second.end());
    const auto found = find_configuration(descriptors, 2);
    ASSERT_TRUE(found.ok());
    EXPECT_EQ(Bytes(found->begin(), found->end()), second);
    EXPECT_EQ(find_configuration(descriptors, 3).error().code, ErrorCode::not_found);
    descriptors.pop_back();
    EXPECT_EQ(find_configuration(descriptors, 2).error().code, ErrorCode::malformed);
}

}  // namespace
}  // namespace gyrolog
