// The input is what sysfs shows as a device's descriptors. Whatever they claim, nothing outside them is read,
// and a layout that is accepted names endpoints that a CDC-ACM function can have.

#include <cstdint>
#include <vector>

#include "host/usb/cdc_descriptors.hpp"
#include "require.hpp"

namespace {

void judge_layout(gyrolog::ByteView configuration) {
    const auto layout = gyrolog::parse_cdc_configuration(configuration);
    if (!layout.ok()) {
        GYROLOG_REQUIRE(layout.error().code == gyrolog::ErrorCode::malformed ||
                        layout.error().code == gyrolog::ErrorCode::unsupported);
        return;
    }
    GYROLOG_REQUIRE((layout->endpoint_in & 0x80U) != 0 && (layout->endpoint_in & 0x0FU) != 0);
    GYROLOG_REQUIRE((layout->endpoint_out & 0x80U) == 0 && (layout->endpoint_out & 0x0FU) != 0);
    GYROLOG_REQUIRE(layout->packet_in_bytes >= 8 && layout->packet_in_bytes <= 512);
    GYROLOG_REQUIRE(layout->packet_out_bytes >= 8 && layout->packet_out_bytes <= 512);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::vector<std::uint8_t> descriptors(
        data, data + size);  // on its own, so that the sanitizers see its end
    judge_layout(descriptors);
    for (std::uint8_t value = 0; value < 3; ++value) {
        const auto found = gyrolog::find_configuration(descriptors, value);
        if (!found.ok()) { continue; }
        GYROLOG_REQUIRE(found->data() >= descriptors.data());
        GYROLOG_REQUIRE(found->data() + found->size() <= descriptors.data() + descriptors.size());
        judge_layout(*found);
    }
    return 0;
}
