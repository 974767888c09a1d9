#include "host/conform/rule.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace gyrolog {

Judgement not_tested(std::string why) {
    Judgement verdict;
    verdict.state = JudgementState::not_tested;
    verdict.expected = std::move(why);
    return verdict;
}

std::string name_of_type(unsigned type) {
    switch (type) {
        case glp_frame_hello:
            return "HELLO";
        case glp_frame_config:
            return "CONFIG";
        case glp_frame_samples:
            return "SAMPLES";
        case glp_frame_status:
            return "STATUS";
        case glp_frame_event:
            return "EVENT";
        case glp_frame_reply:
            return "REPLY";
        case glp_frame_get_hello:
            return "GET_HELLO";
        case glp_frame_configure:
            return "CONFIGURE";
        case glp_frame_start:
            return "START";
        case glp_frame_stop:
            return "STOP";
        case glp_frame_get_status:
            return "GET_STATUS";
        default:
            return fmt::format("type {:02x}", type);
    }
}

std::string name_of_result(unsigned result) {
    switch (result) {
        case glp_result_ok:
            return "ok";
        case glp_result_unknown_command:
            return "unknown_command";
        case glp_result_bad_length:
            return "bad_length";
        case glp_result_bad_value:
            return "bad_value";
        case glp_result_sensor_fault:
            return "sensor_fault";
        default:
            return fmt::format("result {}", result);
    }
}

std::string names_of(const Dialogue& dialogue, Passage stretch) {
    constexpr std::size_t names_max = 8;
    std::string names;
    std::size_t count = 0;
    for (std::size_t i = stretch.begin; i < std::min(stretch.end, dialogue.entries().size()); ++i) {
        const TranscriptEntry& entry = dialogue.entry(i);
        const bool frame = entry.kind == TranscriptEntry::Kind::frame;
        if (!frame && entry.kind != TranscriptEntry::Kind::refused) { continue; }
        if (++count > names_max) { return names + ", ..."; }
        if (!names.empty()) { names += ", "; }
        names += frame ? name_of_type(entry.type) : std::string(glp_status_name(entry.status));
        if (const auto event = event_in(entry)) { names += fmt::format(" {}", event->code); }
    }
    return names.empty() ? "nothing" : names;
}

std::string why_not_asked(const Dialogue& dialogue, const char* otherwise) {
    return dialogue.broken_off.empty() ? otherwise : dialogue.broken_off;
}

}  // namespace gyrolog
