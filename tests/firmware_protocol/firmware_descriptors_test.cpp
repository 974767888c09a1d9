// The USB descriptors in the image of each board, judged by the rules of `gyrolog conform`. tools/firmware
// has read them back from the ELF.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/conform/rule.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> boards() {
    std::vector<std::string> names;
    for (const auto& port :
         fs::directory_iterator(fs::path(std::getenv("GYROLOG_SOURCE_DIR")) / "firmware_protocol/ports")) {
        if (fs::exists(port.path() / "port.json")) { names.push_back(port.path().filename().string()); }
    }
    return names;
}

fs::path descriptors_of(const std::string& board) {
    return fs::path(std::getenv("GYROLOG_BUILD_DIR")) / "firmware" / board / (board + ".usb.json");
}

Bytes bytes_of(const std::string& hexadecimal) {
    Bytes bytes;
    for (std::size_t i = 0; i + 2 <= hexadecimal.size(); i += 2) {
        bytes.push_back(static_cast<std::uint8_t>(std::stoul(hexadecimal.substr(i, 2), nullptr, 16)));
    }
    return bytes;
}

SourceIdentity identity_of(const std::string& board) {
    std::ifstream file(descriptors_of(board));
    const auto told = nlohmann::json::parse(file);
    SourceIdentity identity;
    identity.device_descriptor = bytes_of(told.at("device_descriptor"));
    identity.configuration_descriptor = bytes_of(told.at("configuration_descriptor"));
    identity.product = told.at("product");
    const Bytes& device = identity.device_descriptor;  // USB 2.0, table 9-8
    identity.vendor_id = static_cast<std::uint16_t>(device.at(8) | device.at(9) << 8);
    identity.product_id = static_cast<std::uint16_t>(device.at(10) | device.at(11) << 8);
    return identity;
}

// The rules that do not hold, or were not tested.
std::vector<std::string> broken_rules(SourceIdentity identity) {
    Dialogue dialogue;
    dialogue.identity = std::move(identity);
    std::vector<std::string> broken;
    for (const Rule& rule : usb_rules()) {
        const Judgement judgement = rule.check(dialogue);
        if (judgement.state != JudgementState::pass) {
            broken.push_back(std::string(rule.number) + ": " + judgement.expected + "; came " +
                             judgement.came);
        }
    }
    return broken;
}

TEST(FirmwareDescriptors, OfEachImageConform) {
    const std::vector<std::string> names = boards();
    ASSERT_GE(names.size(), 2U);
    std::size_t judged = 0;
    for (const std::string& board : names) {
        if (!fs::exists(descriptors_of(board))) { continue; }
        EXPECT_EQ(broken_rules(identity_of(board)), std::vector<std::string>()) << board;
        ++judged;
    }
    if (judged < names.size()) { GTEST_SKIP() << "needs the images of all boards"; }
}

TEST(FirmwareDescriptors, AnotherKindOfEndpointIsFound) {
    for (const std::string& board : boards()) {
        if (!fs::exists(descriptors_of(board))) { GTEST_SKIP() << "needs the images of all boards"; }
        SourceIdentity identity = identity_of(board);
        Bytes& bytes = identity.configuration_descriptor;
        bytes.at(bytes.size() - 4) ^= 1;  // bmAttributes of the last endpoint: bulk becomes interrupt
        EXPECT_EQ(broken_rules(std::move(identity)).size(), 1U) << board;
    }
}

}  // namespace
}  // namespace gyrolog
