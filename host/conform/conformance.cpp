#include "host/conform/conformance.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace gyrolog {
namespace {

// "8.10" behind "8.9": number by number.
bool earlier(const char* a, const char* b) {
    while (true) {
        char* rest_a = nullptr;
        char* rest_b = nullptr;
        const unsigned long part_a = std::strtoul(a, &rest_a, 10);
        const unsigned long part_b = std::strtoul(b, &rest_b, 10);
        if (part_a != part_b) { return part_a < part_b; }
        if (*rest_a == '\0' || *rest_b == '\0') { return *rest_a == '\0' && *rest_b != '\0'; }
        a = rest_a + 1;
        b = rest_b + 1;
    }
}

}  // namespace

std::size_t ConformanceReport::count(JudgementState state) const {
    return static_cast<std::size_t>(
        std::count_if(verdicts.begin(), verdicts.end(),
                      [&](const RuleVerdict& one) { return one.verdict.state == state; }));
}

ConformanceReport judge(const Dialogue& dialogue) {
    ConformanceReport report;
    report.device = dialogue.identity.uri;
    report.hello = dialogue.hello();
    report.broken_off = dialogue.broken_off;
    for (const auto rules : {frame_rules(), message_rules(), sequence_rules(), device_rules(), usb_rules()}) {
        for (const Rule& rule : rules) { report.verdicts.push_back({&rule, rule.check(dialogue)}); }
    }
    std::sort(report.verdicts.begin(), report.verdicts.end(), [](const RuleVerdict& a, const RuleVerdict& b) {
        return earlier(a.rule->number, b.rule->number);
    });
    return report;
}

}  // namespace gyrolog
