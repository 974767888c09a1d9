#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host/conform/rule.hpp"

namespace gyrolog {
namespace {

using Kind = TranscriptEntry::Kind;

constexpr std::uint32_t half_of_numbers = 0x80000000U;
constexpr std::uint32_t dropped_at_start_max = 4096;
constexpr double wrap_min_s = 10.0;
constexpr double rate_tolerance = 0.05;
constexpr double step_tolerance_periods = 0.5;
constexpr std::uint64_t fit_samples_min = 20;

bool tells_overflow(const TranscriptEntry& entry) {
    const auto event = event_in(entry);
    return (event && event->code == glp_event_ring_overflow) ||
           (entry.is_frame(glp_frame_samples) && (entry.flags & glp_flag_ring_overflow) != 0);
}

Judgement numbers(const Dialogue& dialogue) {
    Findings findings;
    std::optional<std::uint32_t> expected;
    std::uint32_t excused = 0;  // refused candidates may have been frames, and a start drops what waits
    const bool overflows = std::any_of(dialogue.entries().begin(), dialogue.entries().end(), tells_overflow);
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (entry.kind == Kind::refused) { ++excused; }
        if (entry.kind == Kind::line && entry.raised) { excused += dropped_at_start_max; }
        if (entry.kind != Kind::frame) { continue; }
        if (expected) {
            findings.looked();
            const std::uint32_t left_out = entry.sequence - *expected;
            const bool backward = left_out >= half_of_numbers;
            if (backward || (left_out > excused && !overflows)) {
                findings.wrong(fmt::format("sequence {}{}", *expected, overflows ? " or more" : ""),
                               std::to_string(entry.sequence), &entry);
            }
        }
        expected = entry.sequence + 1;
        excused = 0;
    }
    return findings.judgement("no two frames came");
}

// A SAMPLES frame, also one whose payload is not as it should be: it counts as long as its header is there.
std::optional<glp_samples> counted_samples(const TranscriptEntry& entry) {
    if (const auto samples = samples_in(entry)) { return samples; }
    if (!entry.is_frame(glp_frame_samples) || entry.status != glp_status_bad_length ||
        entry.payload.size() < GLP_SAMPLES_HEADER_BYTES) {
        return std::nullopt;
    }
    const auto number = [&](std::size_t at, unsigned bytes) {
        std::uint64_t value = 0;
        for (unsigned i = 0; i < bytes; ++i) { value |= std::uint64_t{entry.payload[at + i]} << (8U * i); }
        return value;
    };
    glp_samples samples{};
    samples.first_ticks = number(0, 8);
    samples.first_index = number(8, 8);
    samples.lost_samples = static_cast<std::uint32_t>(number(20, 4));
    samples.count = entry.payload[24];
    return samples;
}

Judgement index_from_zero(const Dialogue& dialogue) {
    Findings findings;
    for (const Run& run : dialogue.runs) {
        for (std::size_t i = run.entries.begin; i < run.entries.end; ++i) {
            const auto samples = counted_samples(dialogue.entry(i));
            if (!samples) { continue; }
            findings.looked();
            if (samples->first_index != samples->lost_samples) {
                findings.wrong(fmt::format("first_index {} at a start with lost_samples {}",
                                           samples->lost_samples, samples->lost_samples),
                               std::to_string(samples->first_index), &dialogue.entry(i));
            }
            break;
        }
    }
    return findings.judgement("no SAMPLES came");
}

Judgement index_accounts(const Dialogue& dialogue) {
    Findings findings;
    for (const Run& run : dialogue.runs) {
        bool known = false;
        std::uint64_t next = 0;
        std::uint32_t lost = 0;
        for (std::size_t i = run.entries.begin; i < run.entries.end; ++i) {
            const auto samples = counted_samples(dialogue.entry(i));
            if (!samples) {
                // What was refused may have held samples.
                if (dialogue.entry(i).kind == Kind::refused) { known = false; }
                continue;
            }
            if (known) {
                findings.looked();
                const std::uint64_t expected = next + (samples->lost_samples - lost);
                if (samples->first_index != expected) {
                    findings.wrong(
                        fmt::format("first_index {}: {} was the next one, and lost_samples grew by {}",
                                    expected, next, samples->lost_samples - lost),
                        std::to_string(samples->first_index), &dialogue.entry(i));
                }
            }
            known = true;
            next = samples->first_index + samples->count;
            lost = samples->lost_samples;
        }
    }
    return findings.judgement("no two SAMPLES frames came");
}

Judgement one_boot(const Dialogue& dialogue) {
    Findings findings;
    std::optional<glp_hello> last;
    std::uint32_t last_sequence = 0;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        const auto hello = hello_in(entry);
        if (!hello) { continue; }
        findings.looked();
        if (last && last->boot_id != hello->boot_id && entry.sequence > last_sequence) {
            findings.wrong(fmt::format("boot_id {}: the numbers go on, so there was no reset", last->boot_id),
                           std::to_string(hello->boot_id), &entry);
        }
        last = hello;
        last_sequence = entry.sequence;
    }
    return findings.judgement("no HELLO came");
}

// ---------------------------------------------------------------------------------------------------- ticks

struct Tick {
    std::size_t entry;
    std::uint64_t ticks;
    bool of_samples;
};

std::vector<Tick> ticks_of(const Dialogue& dialogue) {
    std::vector<Tick> all;
    for (std::size_t i = 0; i < dialogue.entries().size(); ++i) {
        const TranscriptEntry& entry = dialogue.entry(i);
        if (const auto samples = samples_in(entry)) { all.push_back({i, samples->first_ticks, true}); }
        if (const auto status = status_in(entry)) { all.push_back({i, status->ticks, false}); }
        if (const auto event = event_in(entry)) { all.push_back({i, event->ticks, false}); }
    }
    return all;
}

Judgement tick_counter(const Dialogue& dialogue) {
    const auto hello = dialogue.hello();
    if (!hello) { return not_tested("no HELLO came"); }
    const bool whole = hello->tick_bits >= 64;
    Findings findings;
    std::array<std::optional<std::uint64_t>, 2> last;  // of STATUS and EVENT, and of SAMPLES
    for (const Tick& tick : ticks_of(dialogue)) {
        findings.looked();
        const TranscriptEntry& entry = dialogue.entry(tick.entry);
        auto& before = last[tick.of_samples ? 1 : 0];
        if (!whole && tick.ticks >> hello->tick_bits != 0) {
            findings.wrong(fmt::format("ticks of {} bits", hello->tick_bits), fmt::format("{:x}", tick.ticks),
                           &entry);
        } else if (before && dialogue.elapsed_s(*before, tick.ticks) < 0.0) {
            findings.wrong(fmt::format("ticks behind {}", *before), std::to_string(tick.ticks), &entry);
        }
        before = tick.ticks;
    }
    return findings.judgement("nothing with a device time came");
}

Judgement tick_wrap(const Dialogue& dialogue) {
    const auto hello = dialogue.hello();
    if (!hello) { return not_tested("no HELLO came"); }
    Findings findings;
    findings.looked();
    const double wrap_s = std::ldexp(1.0, hello->tick_bits) / hello->tick_hz;
    if (wrap_s < wrap_min_s) {
        findings.wrong("2^tick_bits ticks that last 10 s",
                       fmt::format("{} bits at {} Hz: {:.3g} s", hello->tick_bits, hello->tick_hz, wrap_s));
    }
    return findings.judgement({});
}

// Ticks against indices over a run, from its first frame to its last.
struct RateFit {
    double period_s = 0.0;
    std::uint64_t samples = 0;
};

std::optional<RateFit> fitted(const Dialogue& dialogue, const Run& run) {
    std::optional<glp_samples> first;
    std::optional<glp_samples> last;
    double duration_s = 0.0;
    for (std::size_t i = run.entries.begin; i < run.entries.end; ++i) {
        const auto samples = samples_in(dialogue.entry(i));
        if (!samples) { continue; }
        if (last) { duration_s += dialogue.elapsed_s(last->first_ticks, samples->first_ticks); }
        if (!first) { first = samples; }
        last = samples;
    }
    if (!first || last->first_index <= first->first_index) { return std::nullopt; }
    const std::uint64_t samples = last->first_index - first->first_index;
    if (samples < fit_samples_min || !(duration_s > 0.0)) { return std::nullopt; }
    return RateFit{duration_s / static_cast<double>(samples), samples};
}

Judgement instants(const Dialogue& dialogue) {
    Findings findings;
    for (const Run& run : dialogue.runs) {
        const auto fit = fitted(dialogue, run);
        if (!fit) { continue; }
        std::optional<glp_samples> before;
        for (std::size_t i = run.entries.begin; i < run.entries.end; ++i) {
            const TranscriptEntry& entry = dialogue.entry(i);
            const auto samples = samples_in(entry);
            if (!samples) { continue; }
            const bool told = (entry.flags & (glp_flag_time_discontinuity | glp_flag_first_after_start |
                                              glp_flag_data_ready_silent)) != 0;
            if (before && !told && samples->first_index > before->first_index) {
                findings.looked();
                const double periods = static_cast<double>(samples->first_index - before->first_index);
                const double came =
                    dialogue.elapsed_s(before->first_ticks, samples->first_ticks) / fit->period_s;
                if (std::fabs(came - periods) > step_tolerance_periods + 0.02 * periods) {
                    findings.wrong(fmt::format("first_ticks of the first sample's interrupt: {:g} periods "
                                               "after the frame before",
                                               periods),
                                   fmt::format("{:.2f} periods, and no flag time_discontinuity", came),
                                   &entry);
                }
            }
            before = samples;
        }
    }
    return findings.judgement("too few SAMPLES came");
}

Judgement nominal_rate(const Dialogue& dialogue) {
    Findings findings;
    for (const Run& run : dialogue.runs) {
        const auto fit = fitted(dialogue, run);
        if (!fit || !run.config) { continue; }
        findings.looked();
        const double nominal_Hz = run.config->rate_mHz * 1e-3;
        if (std::fabs(1.0 / (fit->period_s * nominal_Hz) - 1.0) <= rate_tolerance) { continue; }
        const TranscriptEntry* config = nullptr;
        for (std::size_t i = run.entries.begin; i < run.entries.end && config == nullptr; ++i) {
            if (config_in(dialogue.entry(i))) { config = &dialogue.entry(i); }
        }
        findings.wrong(fmt::format("{:g} Hz, as CONFIG says, within 5 %", nominal_Hz),
                       fmt::format("{:.4g} Hz, by first_ticks over first_index at the tick rate of HELLO",
                                   1.0 / fit->period_s),
                       config);
    }
    return findings.judgement("too few SAMPLES came");
}

constexpr std::array all_sequence_rules{
    Rule{"5.1", "Each frame has the next sequence number, across stops and starts", numbers},
    Rule{"5.2", "Indices begin at 0 at each start", index_from_zero},
    Rule{"5.3", "Samples sent and lost_samples account for every index", index_accounts},
    Rule{"5.6", "boot_id changes with a reset only", one_boot},
    Rule{"6.1", "Ticks go forward within tick_bits", tick_counter},
    Rule{"6.2", "Ticks do not wrap within 10 s", tick_wrap},
    Rule{"6.3", "first_ticks is the first sample's instant", instants},
    Rule{"6.4", "The rate is the nominal one, within some per cent", nominal_rate},
};

}  // namespace

std::span<const Rule> sequence_rules() { return all_sequence_rules; }

}  // namespace gyrolog
