#include <array>
#include <string>

#include <fmt/format.h>
#include <gyrolog_protocol/cobs.h>
#include <gyrolog_protocol/version.h>

#include "host/conform/rule.hpp"

namespace gyrolog {
namespace {

using Kind = TranscriptEntry::Kind;

constexpr const char* nothing_came = "no frame came";

std::size_t decoded_bytes(const TranscriptEntry& entry) {
    Bytes body(entry.bytes.size() + 1);
    return glp_cobs_decode(entry.bytes.data(), entry.bytes.size(), body.data(), body.size()).size;
}

Judgement unended_bytes(const Dialogue& dialogue) {
    Findings findings;
    const Bytes& rest = dialogue.transcript.unended();
    if (!dialogue.entries().empty()) { findings.looked(); }
    if (!rest.empty() && dialogue.broken_off.empty()) {
        TranscriptEntry entry;
        entry.bytes = rest;
        entry.at_s = dialogue.transcript.now_s();
        findings.wrong("a 00 behind the last frame", fmt::format("{} bytes that nothing ends", rest.size()),
                       &entry);
    }
    return findings.judgement(nothing_came);
}

Judgement both_delimiters(const Dialogue& dialogue) {
    Findings findings;
    bool after_frame = false;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (entry.kind == Kind::sent || entry.kind == Kind::line) { continue; }
        if (entry.kind == Kind::frame && after_frame) {
            findings.looked();
            if (entry.delimiters_before < 2) {
                findings.wrong("a 00 that ends the frame before and a 00 that opens this one",
                               "one 00 for both", &entry);
            }
        }
        after_frame = entry.kind == Kind::frame;
    }
    return findings.judgement(nothing_came);
}

Judgement header(const Dialogue& dialogue) {
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (entry.kind == Kind::refused && entry.status == glp_status_bad_version) {
            findings.wrong(fmt::format("version {}", GLP_PROTOCOL_MAJOR),
                           fmt::format("version {}", entry.version), &entry);
        }
        if (entry.kind != Kind::frame) { continue; }
        findings.looked();
        if (entry.type != glp_frame_samples && entry.flags != 0) {
            findings.wrong(fmt::format("flags 0 in {}", name_of_type(entry.type)),
                           fmt::format("{:04x}", entry.flags), &entry);
        }
    }
    return findings.judgement(nothing_came);
}

Judgement refused_for(const Dialogue& dialogue, glp_status status, const char* expected) {
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (entry.kind == Kind::frame) { findings.looked(); }
        if (entry.kind != Kind::refused || entry.status != status) { continue; }
        findings.wrong(expected,
                       status == glp_status_bad_length
                           ? fmt::format("{} bytes, a body of {}", entry.bytes.size(), decoded_bytes(entry))
                           : fmt::format("{} bytes: {}", entry.bytes.size(), glp_status_name(status)),
                       &entry);
    }
    return findings.judgement(nothing_came);
}

Judgement body_length(const Dialogue& dialogue) {
    return refused_for(dialogue, glp_status_bad_length, "a body of 12 to 1016 bytes between two delimiters");
}

enum class LastGroup : std::uint8_t { other, full, empty_behind_full };

// 254 bytes other than 00 at the body's end have one form; many encoders write another.
LastGroup last_group(const TranscriptEntry& entry) {
    std::size_t code_at = 0;
    std::size_t before = 0;
    while (code_at < entry.bytes.size() && code_at + entry.bytes[code_at] < entry.bytes.size()) {
        before = code_at;
        code_at += entry.bytes[code_at];
    }
    if (code_at >= entry.bytes.size()) { return LastGroup::other; }
    if (entry.bytes[code_at] == 0xFF) { return LastGroup::full; }
    const bool empty = entry.bytes[code_at] == 0x01 && code_at > 0 && entry.bytes[before] == 0xFF;
    return empty ? LastGroup::empty_behind_full : LastGroup::other;
}

Judgement cobs(const Dialogue& dialogue) {
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (entry.kind == Kind::frame) { findings.looked(); }
        if (entry.kind != Kind::refused || entry.status != glp_status_bad_cobs) { continue; }
        if (last_group(entry) == LastGroup::empty_behind_full) { continue; }
        findings.wrong("the COBS form of a body between two delimiters",
                       fmt::format("{} bytes that are none", entry.bytes.size()), &entry);
    }
    return findings.judgement(nothing_came);
}

Judgement full_last_group(const Dialogue& dialogue) {
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (entry.kind == Kind::frame && last_group(entry) == LastGroup::full) { findings.looked(); }
        if (entry.kind == Kind::refused && last_group(entry) == LastGroup::empty_behind_full) {
            findings.wrong("nothing behind a last group of 254 bytes", "a code byte 01", &entry);
        }
    }
    return findings.judgement("no frame ended with 254 bytes other than 00");
}

Judgement checksum(const Dialogue& dialogue) {
    return refused_for(
        dialogue, glp_status_bad_crc,
        "CRC-32, 04C11DB7 reflected, initial value and final xor FFFFFFFF, over header and payload");
}

// ------------------------------------------------------------------------------ the device as the receiver

Judgement answered(const Dialogue& dialogue, std::initializer_list<Ask> asks, const char* manner) {
    Findings findings;
    const auto& plain = dialogue.asked(Ask::status);
    if (!plain || !plain->reply) { return not_tested("a plain GET_STATUS is not answered either"); }
    for (const Ask ask : asks) {
        const auto& exchange = dialogue.asked(ask);
        if (!exchange) { continue; }
        findings.looked();
        if (exchange->replies > 0) { continue; }
        const TranscriptEntry* sent = nullptr;
        for (std::size_t i = exchange->sent; i < dialogue.entries().size() && sent == nullptr; ++i) {
            if (dialogue.entry(i).kind == Kind::sent) { sent = &dialogue.entry(i); }
        }
        findings.wrong(fmt::format("an answer to {} {}", name_of_type(exchange->type), manner),
                       "none within 1 s", sent);
    }
    return findings.judgement(why_not_asked(dialogue, "it was not asked"));
}

Judgement delimiters(const Dialogue& dialogue) {
    Judgement written = both_delimiters(dialogue);
    Judgement taken = answered(dialogue, {Ask::shared_delimiter, Ask::many_delimiters},
                               "that shares its opening 00 with the command before, or stands among many 00");
    return taken.state == JudgementState::fail && written.state != JudgementState::fail ? taken : written;
}

Judgement takes_pieces(const Dialogue& dialogue) {
    return answered(dialogue, {Ask::in_pieces}, "that comes byte by byte");
}

Judgement skips_overlong(const Dialogue& dialogue) {
    return answered(dialogue, {Ask::after_overlong}, "behind 3000 bytes without a 00");
}

Judgement damage_costs_one(const Dialogue& dialogue) {
    return answered(dialogue, {Ask::after_noise, Ask::after_damage},
                    "behind bytes that no frame owns, or behind a command that lacks a byte");
}

// A frame that must be refused: no answer, and no CONFIG that shows what it asked for.
Judgement refused(const Dialogue& dialogue, Ask ask, const char* what) {
    Findings findings;
    const auto& exchange = dialogue.asked(ask);
    if (!exchange || !dialogue.answers_commands()) {
        return not_tested(why_not_asked(dialogue, "no command is answered"));
    }
    findings.looked();
    if (exchange->reply) {
        findings.wrong(fmt::format("no answer to {}", what),
                       fmt::format("REPLY {}", name_of_result(exchange->answer->result)),
                       &dialogue.entry(*exchange->reply));
    }
    return findings.judgement({});
}

Judgement refuses_bad_checksum(const Dialogue& dialogue) {
    return refused(dialogue, Ask::bad_checksum, "a CONFIGURE with a wrong checksum");
}

Judgement refuses_other_version(const Dialogue& dialogue) {
    return refused(dialogue, Ask::other_version, "a CONFIGURE of major version 2");
}

constexpr std::array all_frame_rules{
    Rule{"1.2", "Every frame is ended by a 00", unended_bytes},
    Rule{"1.3", "Frames have both delimiters; commands are taken with one or many between them", delimiters},
    Rule{"1.4", "The header has version 1, and flags in SAMPLES only", header},
    Rule{"1.5", "A body has 12 to 1016 bytes", body_length},
    Rule{"1.6", "What is too long for a frame is skipped up to its delimiter", skips_overlong},
    Rule{"2.1", "A body is written as COBS", cobs},
    Rule{"2.2", "No group follows a full last one", full_last_group},
    Rule{"3.1", "The checksum is right", checksum},
    Rule{"3.2", "A command with a wrong checksum is refused", refuses_bad_checksum},
    Rule{"7.1", "A command of another major version is refused", refuses_other_version},
    Rule{"9.2", "A command may come in pieces", takes_pieces},
    Rule{"9.4", "Damage costs the command that it touches and no other", damage_costs_one},
};

}  // namespace

std::span<const Rule> frame_rules() { return all_frame_rules; }

}  // namespace gyrolog
