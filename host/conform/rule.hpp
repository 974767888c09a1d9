// A rule of SPEC.md as a check of a dialogue. The groups of rules are tables, one a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "host/conform/dialogue.hpp"

namespace gyrolog {

enum class JudgementState : std::uint8_t { pass, fail, not_tested };

struct Judgement {
    JudgementState state = JudgementState::pass;
    std::string expected;  // fail: what the rule asks for; not tested: why not
    std::string came;      // fail
    Bytes bytes;        // fail: of the frame that is wrong (its COBS form), or that should have been answered
    double at_s = 0.0;  // fail: since the conversation began
    std::size_t times = 0;  // fail: how often; the first is told
};

struct Rule {
    const char* number;  // of SPEC.md
    const char* title;
    Judgement (*check)(const Dialogue&);
};

std::span<const Rule> frame_rules();     // sections 1 to 3, and what a device must make of the host's frames
std::span<const Rule> message_rules();   // section 4
std::span<const Rule> sequence_rules();  // sections 5 and 6
std::span<const Rule> device_rules();    // section 8
std::span<const Rule> usb_rules();       // section 10

// Collects what a check finds. The first thing wrong is told; what was looked at decides between pass and not
// tested.
class Findings {
public:
    void looked() { ++looked_at_; }
    void wrong(std::string expected, std::string came, const TranscriptEntry* entry = nullptr) {
        ++looked_at_;
        if (++judgement_.times > 1) { return; }
        judgement_.state = JudgementState::fail;
        judgement_.expected = std::move(expected);
        judgement_.came = std::move(came);
        if (entry == nullptr) { return; }
        judgement_.bytes = entry->bytes;
        judgement_.at_s = entry->at_s;
    }
    Judgement judgement(std::string why_not_tested) const {
        if (looked_at_ > 0) { return judgement_; }
        Judgement none;
        none.state = JudgementState::not_tested;
        none.expected = std::move(why_not_tested);
        return none;
    }

private:
    Judgement judgement_;
    std::size_t looked_at_ = 0;
};

Judgement not_tested(std::string why);
// "SAMPLES", "type 20".
std::string name_of_type(unsigned type);
std::string name_of_result(unsigned result);
// "REPLY, HELLO, CONFIG"; the first few of them.
std::string names_of(const Dialogue& dialogue, Passage stretch);
// Why an exchange was not had.
std::string why_not_asked(const Dialogue& dialogue, const char* otherwise);

}  // namespace gyrolog
