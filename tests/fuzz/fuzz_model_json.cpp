// Any text at all: parsing ends in a model that can be written and read again as the same text, in an effect
// that can be simulated, or in an error.

#include <cstdint>
#include <string_view>

#include "analysis/simulate/effect.hpp"
#include "host/formats/described_effect_json.hpp"
#include "host/formats/model_json.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto effect = gyrolog::parse_described_effect(text, "input");
    GYROLOG_REQUIRE(effect.ok() ? !gyrolog::effect_refusal(effect->entry) : !effect.error().message.empty());
    const auto model = gyrolog::parse_model(text, "input");
    if (!model.ok()) {
        GYROLOG_REQUIRE(!model.error().message.empty());
        return 0;
    }
    const std::string written = gyrolog::format_model(*model);
    const auto again = gyrolog::parse_model(written, "written");
    GYROLOG_REQUIRE(again.ok());
    GYROLOG_REQUIRE(gyrolog::format_model(*again) == written);
    return 0;
}
