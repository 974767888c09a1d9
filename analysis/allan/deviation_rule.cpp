#include "analysis/allan/deviation_rule.hpp"

#include <algorithm>
#include <array>

namespace gyrolog {
namespace {

constexpr std::array rules = {
    DeviationRule{DeviationKind::overlapping, "overlapping", 2, true, false, false, false},
    DeviationRule{DeviationKind::standard, "standard", 2, false, false, false, false},
    DeviationRule{DeviationKind::standard_halving, "standard_halving", 2, false, false, false, true},
    DeviationRule{DeviationKind::modified, "modified", 2, true, true, false, false},
    DeviationRule{DeviationKind::hadamard, "hadamard", 3, false, false, false, false},
    DeviationRule{DeviationKind::overlapping_hadamard, "overlapping_hadamard", 3, true, false, false, false},
    DeviationRule{DeviationKind::total, "total", 2, true, false, true, false},
};

constexpr bool in_order_of_kinds() {
    for (std::size_t i = 0; i < rules.size(); ++i) {
        if (rules[i].kind != all_deviation_kinds[i] || static_cast<std::size_t>(rules[i].kind) != i) {
            return false;
        }
    }
    return rules.size() == all_deviation_kinds.size();
}
static_assert(in_order_of_kinds());

}  // namespace

std::int64_t DeviationRule::terms(std::int64_t points, std::int64_t m) const {
    const std::int64_t room = points - reach(m);
    if (room <= 0) { return 0; }
    return reflected ? points - 2 : (room + stride(m) - 1) / stride(m);
}

double DeviationRule::norm(std::int64_t m) const {
    const auto samples = static_cast<double>(m);
    return (order == 2 ? 2.0 : 6.0) * samples * samples * (window_mean ? samples * samples : 1.0);
}

TermRun run_of(const DeviationRule& rule, std::span<const Segment> segments, std::size_t segment,
               PhaseConvention convention, std::int64_t m) {
    const std::int64_t stride = rule.stride(m);
    const std::int64_t place = segments[segment].first_index - segments.front().first_index;
    const std::int64_t aligned = (place + stride - 1) / stride * stride;
    const std::int64_t left_out = convention == PhaseConvention::matlab ? 1 : 0;
    const std::int64_t begin = aligned - place + left_out;
    return {begin, rule.terms(static_cast<std::int64_t>(segments[segment].count) + 1 - begin, m)};
}

std::vector<std::int64_t> terms_of_runs(const DeviationRule& rule, std::span<const Segment> segments,
                                        PhaseConvention convention, std::int64_t m) {
    std::vector<std::int64_t> all;
    for (std::size_t s = 0; s < segments.size(); ++s) {
        const TermRun run = run_of(rule, segments, s, convention, m);
        if (run.terms > 0) { all.push_back(run.terms); }
    }
    return all;
}

const DeviationRule& rule_of(DeviationKind kind) { return rules.at(static_cast<std::size_t>(kind)); }

std::string_view name_of(DeviationKind kind) { return rule_of(kind).name; }

std::string_view name_of(PhaseConvention convention) {
    return convention == PhaseConvention::sp1065 ? "sp1065" : "matlab";
}

std::optional<DeviationKind> deviation_kind(std::string_view name) {
    const auto* const rule = std::ranges::find(rules, name, &DeviationRule::name);
    if (rule == rules.end()) { return std::nullopt; }
    return rule->kind;
}

}  // namespace gyrolog
