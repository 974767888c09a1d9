#include "host/formats/conform_report.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host/base/printable.hpp"
#include "host/formats/json.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t text_bytes_max = 96;

const char* name_of(JudgementState state) {
    switch (state) {
        case JudgementState::pass:
            return "pass";
        case JudgementState::fail:
            return "fail";
        case JudgementState::not_tested:
            break;
    }
    return "not_tested";
}

std::string hex(ByteView bytes) {
    std::string text;
    text.reserve(2 * bytes.size());
    for (const std::uint8_t byte : bytes) { text += fmt::format("{:02x}", byte); }
    return text;
}

std::string spaced_hex(const Bytes& bytes) {
    std::string text;
    for (const std::uint8_t byte : ByteView(bytes).first(std::min(bytes.size(), text_bytes_max))) {
        text += fmt::format(" {:02x}", byte);
    }
    if (bytes.size() > text_bytes_max) { text += fmt::format(" ... ({} bytes)", bytes.size()); }
    return text;
}

std::string words_of(const TranscriptEntry& entry) {
    switch (entry.kind) {
        case TranscriptEntry::Kind::line:
            return entry.raised ? "DTR rises" : "DTR falls";
        case TranscriptEntry::Kind::sent:
            return "sent";
        case TranscriptEntry::Kind::refused:
            return fmt::format("refused {}", glp_status_name(entry.status));
        case TranscriptEntry::Kind::frame:
            break;
    }
    const char* problem = entry.status == glp_status_ok ? "" : glp_status_name(entry.status);
    return fmt::format("{} {} flags {:04x} {}", name_of_type(entry.type), entry.sequence, entry.flags,
                       problem);
}

// " (5.2, 4.9.2)" behind the number of rules that fail; empty where none does.
std::string failed_rules(const ConformanceReport& report) {
    std::string numbers;
    for (const RuleVerdict& one : report.verdicts) {
        if (one.verdict.state != JudgementState::fail) { continue; }
        numbers.append(numbers.empty() ? "" : ", ").append(one.rule->number);
    }
    return numbers.empty() ? "" : " (" + numbers + ")";
}

}  // namespace

std::string transcript_text(const Dialogue& dialogue) {
    std::string text;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        text += fmt::format("{:9.4f} s  {:<28} {}\n", entry.at_s, words_of(entry), hex(entry.bytes));
    }
    return text;
}

Json conform_json(const ConformanceReport& report) {
    auto rules = Json::array();
    for (const RuleVerdict& one : report.verdicts) {
        const Judgement& verdict = one.verdict;
        Json rule = {
            {"rule", one.rule->number}, {"title", one.rule->title}, {"verdict", name_of(verdict.state)}};
        if (verdict.state == JudgementState::not_tested) { rule["why"] = verdict.expected; }
        if (verdict.state == JudgementState::fail) {
            rule["expected"] = verdict.expected;
            rule["came"] = verdict.came;
            rule["bytes"] = hex(verdict.bytes);
            rule["at_s"] = verdict.at_s;
            rule["times"] = verdict.times;
        }
        rules.push_back(std::move(rule));
    }
    Json board;
    if (report.hello) {
        board = {{"firmware", printable(report.hello->firmware)},
                 {"sensor", printable(report.hello->sensor)},
                 {"uid", hex(report.hello->uid)},
                 {"boot_id", report.hello->boot_id}};
    }
    return {{"schema", "gyrolog-conform/1"},
            {"device", report.device},
            {"board", board},
            {"conforms", report.conforms()},
            {"broken_off", report.broken_off},
            {"passed", report.count(JudgementState::pass)},
            {"failed", report.count(JudgementState::fail)},
            {"not_tested", report.count(JudgementState::not_tested)},
            {"rules", std::move(rules)}};
}

std::string conform_text(const ConformanceReport& report) {
    std::string text = report.device;
    if (report.hello) {
        text += fmt::format(": {}, {}", printable(report.hello->firmware), printable(report.hello->sensor));
    }
    text += '\n';
    for (const RuleVerdict& one : report.verdicts) {
        const Judgement& verdict = one.verdict;
        const char* word = verdict.state == JudgementState::pass   ? "pass"
                           : verdict.state == JudgementState::fail ? "FAIL"
                                                                   : "-";
        text += wrapped_text(fmt::format("{:<5} {:<4} ", one.rule->number, word), one.rule->title);
        if (verdict.state == JudgementState::not_tested) {
            text += wrapped_text("           not tested: ", verdict.expected);
        }
        if (verdict.state != JudgementState::fail) { continue; }
        text += wrapped_text("           expected: ", verdict.expected) +
                wrapped_text("           came:     ", verdict.came);
        if (!verdict.bytes.empty()) {
            text += wrapped_text(fmt::format("           at {:.3f} s: ", verdict.at_s),
                                 spaced_hex(verdict.bytes));
        }
        if (verdict.times > 1) {
            text += fmt::format("           {} times; this is the first\n", verdict.times);
        }
    }
    if (!report.broken_off.empty()) {
        text += wrapped_text("the conversation was broken off: ", report.broken_off);
    }
    text += fmt::format("{}: {} rules pass, {} fail{}, {} not tested\n",
                        report.conforms() ? "conforms" : "does not conform",
                        report.count(JudgementState::pass), report.count(JudgementState::fail),
                        failed_rules(report), report.count(JudgementState::not_tested));
    return text;
}

}  // namespace gyrolog
