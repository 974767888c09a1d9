// Judges a device by the numbered rules of SPEC.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/conform/rule.hpp"

namespace gyrolog {

struct RuleVerdict {
    const Rule* rule;
    Judgement verdict;
};

struct ConformanceReport {
    std::string device;
    std::optional<glp_hello> hello;
    std::string broken_off;             // why the conversation ended early; empty when it did not
    std::vector<RuleVerdict> verdicts;  // in the order of the specification

    std::size_t count(JudgementState state) const;
    bool conforms() const { return count(JudgementState::fail) == 0 && count(JudgementState::pass) > 0; }
};

ConformanceReport judge(const Dialogue& dialogue);

}  // namespace gyrolog
