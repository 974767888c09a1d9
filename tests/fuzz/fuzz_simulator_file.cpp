// Any text at all: a simulator's file ends in the models of its sensors, or in an error; a file that is
// changed to a model is one of as many sensors, with that model's noise in it.

#include <cstdint>
#include <string>

#include "host/formats/model_source.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using namespace gyrolog;

constexpr std::size_t sensors_looked_at = 3;

void look_at(const std::string& text, const std::string& sensor) {
    const auto source = parse_model_source(text, {"input", sensor}, 1);
    if (!source.ok()) {
        GYROLOG_REQUIRE(!source.error().message.empty());
        return;
    }
    if (source->simulator == nullptr) { return; }
    GYROLOG_REQUIRE(!source->file.notes.empty());
    ModelFile file = source->file;
    if (file.unstated.rate) { state_rate(file, 100.0); }
    const auto changed = changed_simulator_file(*source, file.model, "input", 10.0 / file.model.rate_hz);
    GYROLOG_REQUIRE(changed.ok() || changed.error().code == ErrorCode::unsupported);
    if (!changed.ok()) { return; }
    const auto again = open_simulator_file(changed->text);
    GYROLOG_REQUIRE(again.ok() && *again != nullptr);
    GYROLOG_REQUIRE((*again)->sensors() == source->simulator->sensors());
    GYROLOG_REQUIRE((*again)->model(source->sensor).ok());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const auto file = open_simulator_file(text);
    if (!file.ok()) {
        GYROLOG_REQUIRE(!file.error().message.empty());
        return 0;
    }
    if (*file == nullptr) { return 0; }
    const std::vector<std::string>& names = (*file)->sensors();
    GYROLOG_REQUIRE(!names.empty());
    look_at(text, "");
    for (std::size_t i = 0; i < names.size() && i < sensors_looked_at; ++i) { look_at(text, names[i]); }
    return 0;
}
