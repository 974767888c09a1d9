#include "host/decode/contradiction.hpp"

#include <algorithm>

#include "host/base/counted.hpp"

namespace gyrolog {
namespace {

std::string sentence(Contradiction kind, std::uint64_t count) {
    const std::string times = " (" + counted(count, "time") + ")";
    switch (kind) {
        case Contradiction::lost_samples:
            return "the board counts " + counted(count, "sample") +
                   " as lost, and no gap in its indices has room for that";
        case Contradiction::lost_frames:
            return "the board counts " + counted(count, "frame") +
                   " as dropped, and no gap in their numbers has room for that";
        case Contradiction::index_again:
            return "samples have an index that earlier ones had, and the board was not started anew" + times;
        case Contradiction::index_ahead:
            return "samples have an index that no sensor reaches in the time since those before" + times;
        case Contradiction::counted_short:
            return "the board counts fewer samples than it had sent" + times;
        case Contradiction::counted_ahead:
            return "the board counts more samples than any sensor makes in the time since its last" + times;
    }
    return {};
}

}  // namespace

bool any(const Contradictions& contradictions) {
    return std::ranges::any_of(contradictions, [](std::uint64_t count) { return count > 0; });
}

std::vector<std::string> sentences(const Contradictions& contradictions) {
    std::vector<std::string> all;
    for (std::size_t kind = 0; kind < contradiction_kinds; ++kind) {
        if (contradictions[kind] == 0) { continue; }
        all.push_back(sentence(static_cast<Contradiction>(kind), contradictions[kind]));
    }
    return all;
}

}  // namespace gyrolog
