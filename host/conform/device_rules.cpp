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

constexpr double status_period_s = 1.0;
constexpr double hello_period_s = 5.0;
constexpr double period_tolerance = 0.3;
constexpr double patience_s = 0.1;
constexpr double frame_span_min_s = 0.02;  // "about 40 ms"
constexpr double frame_span_max_s = 0.08;

const TranscriptEntry* at(const Dialogue& dialogue, std::size_t i) {
    return i < dialogue.entries().size() ? &dialogue.entry(i) : nullptr;
}

// The place of the first frame of a type (and event code) in a stretch, or its end.
std::size_t place_of(const Dialogue& dialogue, Passage stretch, unsigned type, unsigned code = 0) {
    for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
        const TranscriptEntry& entry = dialogue.entry(i);
        if (!entry.is_frame(type)) { continue; }
        if (code == 0) { return i; }
        const auto event = event_in(entry);
        if (event && event->code == code) { return i; }
    }
    return stretch.end;
}

bool has(const Dialogue& dialogue, Passage stretch, unsigned type, unsigned code = 0) {
    return place_of(dialogue, stretch, type, code) != stretch.end;
}

Passage answer_of(const Exchange& exchange) { return {*exchange.reply, exchange.end}; }

// HELLO, CONFIG, EVENT started and SAMPLES of a run, in this order.
void check_introduction(const Dialogue& dialogue, Passage stretch, Findings& findings) {
    findings.looked();
    const std::size_t samples = place_of(dialogue, stretch, glp_frame_samples);
    const std::size_t hello = place_of(dialogue, stretch, glp_frame_hello);
    const std::size_t config = place_of(dialogue, stretch, glp_frame_config);
    const std::size_t started = place_of(dialogue, stretch, glp_frame_event, glp_event_started);
    if (hello < config && config < started && started < samples && samples < stretch.end) { return; }
    findings.wrong("HELLO, CONFIG, EVENT 1 (started), then SAMPLES", names_of(dialogue, stretch),
                   at(dialogue, stretch.begin));
}

Judgement rising_dtr(const Dialogue& dialogue) {
    if (!dialogue.has_line) { return not_tested("the line has no DTR"); }
    Findings findings;
    for (const Run& run : dialogue.runs) {
        if (run.by == Run::By::line) {
            check_introduction(dialogue, {run.entries.begin + 1, run.entries.end}, findings);
        }
    }
    return findings.judgement(why_not_asked(dialogue, "it was not started"));
}

Judgement falling_dtr(const Dialogue& dialogue) {
    if (!dialogue.has_line) { return not_tested("the line has no DTR"); }
    if (!dialogue.lowered) { return not_tested(why_not_asked(dialogue, "it was not started")); }
    Findings findings;
    findings.looked();
    const Passage& stretch = *dialogue.lowered;
    const std::size_t stopped = place_of(dialogue, stretch, glp_frame_event, glp_event_stopped);
    if (stopped == stretch.end) {
        findings.wrong("EVENT 2 (stopped) behind the last samples", names_of(dialogue, stretch),
                       at(dialogue, stretch.begin));
    } else if (stopped + 1 < stretch.end) {
        findings.wrong("nothing behind EVENT 2 (stopped)", names_of(dialogue, {stopped + 1, stretch.end}),
                       at(dialogue, stopped + 1));
    }
    return findings.judgement({});
}

Judgement start_and_stop(const Dialogue& dialogue) {
    Findings findings;
    for (const Run& run : dialogue.runs) {
        if (run.by == Run::By::command) { check_introduction(dialogue, run.entries, findings); }
    }
    const auto& again = dialogue.asked(Ask::start_again);
    if (again && again->reply) {
        findings.looked();
        if (again->answer->result != glp_result_ok ||
            has(dialogue, answer_of(*again), glp_frame_event, glp_event_started)) {
            findings.wrong("START while streaming: REPLY ok, and nothing changes",
                           names_of(dialogue, answer_of(*again)), at(dialogue, *again->reply));
        }
    }
    const auto& idle = dialogue.asked(Ask::stop_while_stopped);
    if (idle && idle->reply) {
        findings.looked();
        if (idle->answer->result != glp_result_ok || has(dialogue, answer_of(*idle), glp_frame_event)) {
            findings.wrong("STOP while stopped: REPLY ok, and nothing changes",
                           names_of(dialogue, answer_of(*idle)), at(dialogue, *idle->reply));
        }
    }
    const auto& stop = dialogue.asked(Ask::stop);
    const auto& after = dialogue.asked(Ask::status_after_stop);
    if (stop && stop->reply && after && after->reply) {
        findings.looked();
        if (!has(dialogue, {stop->sent, *after->reply}, glp_frame_event, glp_event_stopped)) {
            findings.wrong("EVENT 2 (stopped) at a STOP", names_of(dialogue, answer_of(*stop)),
                           at(dialogue, *stop->reply));
        } else if (has(dialogue, answer_of(*after), glp_frame_samples)) {
            findings.wrong("no SAMPLES after a STOP", names_of(dialogue, answer_of(*after)),
                           at(dialogue, *after->reply));
        }
    }
    return findings.judgement(why_not_asked(dialogue, "no START or STOP was answered"));
}

// ------------------------------------------------------------------------------------------------- replies

void check_one_reply(const Dialogue& dialogue, Ask ask, Findings& findings) {
    const auto& exchange = dialogue.asked(ask);
    if (!exchange) { return; }
    findings.looked();
    if (exchange->replies != 1) {
        findings.wrong(fmt::format("one REPLY to {}", name_of_type(exchange->type)),
                       fmt::format("{} of them", exchange->replies),
                       exchange->reply ? at(dialogue, *exchange->reply) : at(dialogue, exchange->sent));
    }
}

void check_followed_by(const Dialogue& dialogue, Ask ask, std::initializer_list<unsigned> types,
                       const char* expected, Findings& findings) {
    const auto& exchange = dialogue.asked(ask);
    if (!exchange || !exchange->reply) { return; }
    std::size_t from = *exchange->reply;
    for (const unsigned type : types) {
        const std::size_t place = place_of(dialogue, {from, exchange->end}, type);
        if (place == exchange->end) {
            findings.wrong(expected, names_of(dialogue, answer_of(*exchange)),
                           at(dialogue, *exchange->reply));
            return;
        }
        from = place + 1;
    }
}

Judgement replies(const Dialogue& dialogue) {
    Findings findings;
    for (const Ask ask : {Ask::hello,
                          Ask::status,
                          Ask::unknown_type,
                          Ask::short_configure,
                          Ask::bad_full_scale,
                          Ask::bad_combination,
                          Ask::bad_layout,
                          Ask::too_many_samples,
                          Ask::hello_after_refusals,
                          Ask::stop_while_stopped,
                          Ask::rate_slow,
                          Ask::rate_third,
                          Ask::rate_kilohertz,
                          Ask::one_field,
                          Ask::standard,
                          Ask::start,
                          Ask::start_again,
                          Ask::hello_streaming,
                          Ask::status_streaming,
                          Ask::refused_streaming,
                          Ask::unknown_streaming,
                          Ask::configure_streaming,
                          Ask::status_stopped,
                          Ask::decimated,
                          Ask::stop,
                          Ask::status_after_stop,
                          Ask::start_by_command,
                          Ask::status_at_end,
                          Ask::stop_at_end}) {
        check_one_reply(dialogue, ask, findings);
    }
    for (const Ask ask : {Ask::hello, Ask::hello_after_refusals, Ask::hello_streaming}) {
        check_followed_by(dialogue, ask, {glp_frame_hello, glp_frame_config}, "REPLY, HELLO, CONFIG",
                          findings);
    }
    const auto& hello = dialogue.asked(Ask::hello_streaming);
    if (hello && hello->reply && has(dialogue, answer_of(*hello), glp_frame_event, glp_event_started)) {
        findings.wrong("REPLY, HELLO, CONFIG, and the stream goes on", names_of(dialogue, answer_of(*hello)),
                       at(dialogue, *hello->reply));
    }
    for (const Ask ask : {Ask::status, Ask::status_streaming, Ask::status_stopped}) {
        check_followed_by(dialogue, ask, {glp_frame_status}, "REPLY, STATUS", findings);
    }
    for (const Ask ask : {Ask::unknown_type, Ask::unknown_streaming}) {
        const auto& exchange = dialogue.asked(ask);
        if (exchange && exchange->answer && exchange->answer->result != glp_result_unknown_command) {
            findings.wrong("REPLY unknown_command to a type that is none",
                           fmt::format("REPLY {}", name_of_result(exchange->answer->result)),
                           at(dialogue, *exchange->reply));
        }
    }
    const auto& echo = dialogue.asked(Ask::echo);
    if (echo && echo->reply) {
        findings.wrong("no answer to a frame of type 04, which is an echo",
                       fmt::format("REPLY {}", name_of_result(echo->answer->result)),
                       at(dialogue, *echo->reply));
    }
    return findings.judgement(why_not_asked(dialogue, "nothing was asked"));
}

// ------------------------------------------------------------------------------------ CONFIGURE, and the
// rhythm

// A CONFIG that no HELLO goes before: one that is not repeated every 5 s.
bool has_config_alone(const Dialogue& dialogue, Passage stretch) {
    for (std::size_t i = std::max<std::size_t>(stretch.begin, 1); i < stretch.end; ++i) {
        if (dialogue.entry(i).is_frame(glp_frame_config) &&
            !dialogue.entry(i - 1).is_frame(glp_frame_hello)) {
            return true;
        }
    }
    return false;
}

void check_generation(const Dialogue& dialogue, const Exchange& exchange, Findings& findings) {
    const std::size_t place = place_of(dialogue, answer_of(exchange), glp_frame_config);
    if (place == exchange.end) {
        findings.wrong("REPLY, CONFIG", names_of(dialogue, answer_of(exchange)),
                       at(dialogue, *exchange.reply));
        return;
    }
    const auto before = dialogue.last_config_before(*exchange.reply);
    const auto now = config_in(dialogue.entry(place));
    if (!before || !now) { return; }
    const auto next = static_cast<std::uint16_t>(before->generation + 1U);
    if (now->generation != next) {
        findings.wrong(fmt::format("generation {}", next), std::to_string(now->generation),
                       at(dialogue, place));
    }
}

Judgement configuring(const Dialogue& dialogue) {
    Findings findings;
    for (const Ask ask : {Ask::rate_slow, Ask::rate_third, Ask::rate_kilohertz, Ask::one_field, Ask::standard,
                          Ask::configure_streaming, Ask::decimated}) {
        const auto& exchange = dialogue.asked(ask);
        if (!exchange || !exchange->answer || exchange->answer->result != glp_result_ok) { continue; }
        findings.looked();
        check_generation(dialogue, *exchange, findings);
    }
    const auto& changed = dialogue.asked(Ask::configure_streaming);
    if (changed && changed->answer && changed->answer->result == glp_result_ok) {
        const Passage answer = answer_of(*changed);
        const std::size_t config = place_of(dialogue, answer, glp_frame_config);
        const std::size_t started = place_of(dialogue, answer, glp_frame_event, glp_event_started);
        const std::size_t samples = place_of(dialogue, answer, glp_frame_samples);
        const bool stopped =
            has(dialogue, {changed->sent, *changed->reply}, glp_frame_event, glp_event_stopped);
        if (config != answer.end &&
            (!stopped || started == answer.end || started < config || samples < started)) {
            findings.wrong(
                "EVENT 2 (stopped), REPLY, CONFIG, EVENT 1 (started), SAMPLES at a CONFIGURE while streaming",
                (stopped ? "EVENT 2, " : "") + names_of(dialogue, answer), at(dialogue, *changed->reply));
        }
    }
    const auto& refused = dialogue.asked(Ask::refused_streaming);
    if (refused && refused->answer && refused->answer->result == glp_result_bad_value) {
        findings.looked();
        Passage answer = answer_of(*refused);
        // What comes behind the next command that changes something is that one's.
        if (changed) { answer.end = std::min(answer.end, std::max(answer.begin, changed->sent)); }
        if (has_config_alone(dialogue, answer) || has(dialogue, answer, glp_frame_event, glp_event_stopped) ||
            has(dialogue, answer, glp_frame_event, glp_event_started)) {
            findings.wrong("REPLY alone to a refused CONFIGURE", names_of(dialogue, answer_of(*refused)),
                           at(dialogue, *refused->reply));
        }
    }
    return findings.judgement(why_not_asked(dialogue, "no CONFIGURE was accepted"));
}

// Device time since the quiet run's first sample, at each of its frames: of the last SAMPLES before it.
class RunClock {
public:
    explicit RunClock(const Dialogue& dialogue) : dialogue_(dialogue) {}
    void pass(const TranscriptEntry& entry) {
        const auto samples = samples_in(entry);
        if (!samples) { return; }
        if (running_) { now_s_ += dialogue_.elapsed_s(last_ticks_, samples->first_ticks); }
        last_ticks_ = samples->first_ticks;
        running_ = true;
    }
    bool running() const { return running_; }
    double now_s() const { return now_s_; }

private:
    const Dialogue& dialogue_;
    bool running_ = false;
    std::uint64_t last_ticks_ = 0;
    double now_s_ = 0.0;
};

void check_rhythm(const Dialogue& dialogue, unsigned type, double period_s, Findings& findings) {
    const Passage& run = *dialogue.quiet_run;
    RunClock clock(dialogue);
    double last_s = 0.0;
    const TranscriptEntry* last = nullptr;
    const std::string expected =
        fmt::format("a {} every {:g} s of device time", name_of_type(type), period_s);
    for (std::size_t i = run.begin; i < run.end; ++i) {
        const TranscriptEntry& entry = dialogue.entry(i);
        clock.pass(entry);
        if (!clock.running() || !entry.is_frame(type)) { continue; }
        if (std::fabs(clock.now_s() - last_s - period_s) > period_tolerance * period_s) {
            findings.wrong(expected, fmt::format("one after {:.2f} s", clock.now_s() - last_s), &entry);
        }
        last_s = clock.now_s();
        last = &entry;
    }
    if (!clock.running()) { return; }
    findings.looked();
    if (clock.now_s() - last_s > (1.0 + period_tolerance) * period_s) {
        findings.wrong(expected, fmt::format("none for {:.2f} s", clock.now_s() - last_s), last);
    }
}

Judgement rhythm(const Dialogue& dialogue) {
    if (!dialogue.quiet_run) { return not_tested(why_not_asked(dialogue, "it was not started")); }
    Findings findings;
    check_rhythm(dialogue, glp_frame_status, status_period_s, findings);
    check_rhythm(dialogue, glp_frame_hello, hello_period_s, findings);
    check_rhythm(dialogue, glp_frame_config, hello_period_s, findings);
    return findings.judgement("no SAMPLES came");
}

Judgement patience(const Dialogue& dialogue) {
    Findings findings;
    for (const Run& run : dialogue.runs) {
        if (!run.config || run.by != Run::By::configure) { continue; }
        const double rate_Hz = run.config->rate_mHz * 1e-3;
        const double longest =
            std::floor(patience_s * rate_Hz) + 2.0;  // one that came just then, one for its clock
        if (run.config->samples_per_frame <= longest) { continue; }
        for (std::size_t i = run.entries.begin; i < run.entries.end; ++i) {
            const auto samples = samples_in(dialogue.entry(i));
            if (!samples) { continue; }
            findings.looked();
            if (samples->count > longest) {
                findings.wrong(
                    fmt::format("at most {:g} samples a frame at {:g} Hz: none waits longer than 100 ms",
                                longest, rate_Hz),
                    fmt::format("{} samples", samples->count), &dialogue.entry(i));
            }
        }
    }
    return findings.judgement("no SAMPLES came at a rate at which frames fill slowly");
}

Judgement chosen_samples(const Dialogue& dialogue) {
    Findings findings;
    for (const Ask ask : {Ask::standard, Ask::decimated}) {
        const auto& exchange = dialogue.asked(ask);
        if (!exchange || !exchange->answer || exchange->answer->result != glp_result_ok) { continue; }
        const std::size_t place = place_of(dialogue, answer_of(*exchange), glp_frame_config);
        const auto config = place < exchange->end ? config_in(dialogue.entry(place)) : std::nullopt;
        if (!config) { continue; }
        findings.looked();
        const double span_s = config->samples_per_frame / (config->rate_mHz * 1e-3);
        if (span_s < frame_span_min_s || span_s > frame_span_max_s) {
            findings.wrong(
                "about 40 ms of samples a frame when the device may choose",
                fmt::format("{} samples a frame: {:g} ms", config->samples_per_frame, span_s * 1e3),
                at(dialogue, place));
        }
    }
    return findings.judgement("no CONFIGURE that leaves the choice was accepted");
}

// ---------------------------------------------------------------------------------------- losses, faults,
// rest

Judgement losses(const Dialogue& dialogue) {
    constexpr unsigned cause_flags = glp_flag_sensor_fifo_overflow | glp_flag_bus_error |
                                     glp_flag_ring_overflow | glp_flag_time_discontinuity |
                                     glp_flag_data_ready_silent;
    Findings findings;
    for (const Run& run : dialogue.runs) {
        std::optional<std::uint32_t> lost;
        for (std::size_t i = run.entries.begin; i < run.entries.end; ++i) {
            const auto samples = samples_in(dialogue.entry(i));
            if (!samples) { continue; }
            if (samples->lost_samples != lost.value_or(0)) {
                findings.looked();
                if ((dialogue.entry(i).flags & cause_flags) == 0) {
                    findings.wrong(fmt::format("a flag that says why lost_samples grew from {} to {}",
                                               lost.value_or(0), samples->lost_samples),
                                   fmt::format("flags {:04x}", dialogue.entry(i).flags), &dialogue.entry(i));
                }
            }
            lost = samples->lost_samples;
        }
    }
    return findings.judgement("nothing was lost");
}

Judgement sensor_fault(const Dialogue& dialogue) {
    Findings findings;
    for (const Ask ask : {Ask::start, Ask::start_by_command}) {
        const auto& exchange = dialogue.asked(ask);
        if (!exchange || !exchange->answer || exchange->answer->result != glp_result_sensor_fault) {
            continue;
        }
        findings.looked();
        if (!has(dialogue, answer_of(*exchange), glp_frame_event, glp_event_sensor_fault) &&
            !has(dialogue, answer_of(*exchange), glp_frame_event, glp_event_bus_error)) {
            findings.wrong("EVENT 6 (sensor_fault) after HELLO", names_of(dialogue, answer_of(*exchange)),
                           at(dialogue, *exchange->reply));
        }
    }
    return findings.judgement("the sensor is in order");
}

Judgement setup_at_boot(const Dialogue& dialogue) {
    const auto& asked = dialogue.asked(Ask::hello);
    if (!asked || !asked->reply) { return not_tested("GET_HELLO is not answered"); }
    const std::size_t place = place_of(dialogue, answer_of(*asked), glp_frame_config);
    const auto config = place < asked->end ? config_in(dialogue.entry(place)) : std::nullopt;
    if (!config) { return not_tested("no CONFIG came"); }
    if (config->generation != 0) {
        return not_tested("the device has been set up since its boot; reset it first");
    }
    Findings findings;
    findings.looked();
    if (config->rate_mHz != 100'000 || config->gyro_full_scale_dps != 500 ||
        config->accel_full_scale_g != 8 || config->dlpf_hz != 41 || config->samples_per_frame != 4) {
        findings.wrong("100 Hz, ±500 °/s, ±8 g, filter 41 Hz, 4 samples a frame",
                       fmt::format("{:g} Hz, ±{} °/s, ±{} g, filter {} Hz, {} samples a frame",
                                   config->rate_mHz * 1e-3, config->gyro_full_scale_dps,
                                   config->accel_full_scale_g, config->dlpf_hz, config->samples_per_frame),
                       at(dialogue, place));
    }
    return findings.judgement({});
}

Judgement ring_overflow(const Dialogue& /*dialogue*/) {
    return not_tested(
        "it takes a host that does not read; the virtual bench in tests/firmware_protocol does");
}

// What an answer to a command may bring besides REPLY.
bool belongs_to_answer(unsigned command, unsigned type) {
    if (type == glp_frame_event) {
        return true;
    }  // a fault found at a set-up, and what a stop or a start brings
    switch (command) {
        case glp_frame_get_hello:
            return type == glp_frame_hello || type == glp_frame_config;
        case glp_frame_configure:
            return type == glp_frame_config;
        case glp_frame_get_status:
            return type == glp_frame_status;
        default:
            return false;
    }
}

Judgement silent_until_asked(const Dialogue& dialogue) {
    Findings findings;
    if (dialogue.never_quiet) {
        findings.wrong("silence after DTR fell and a STOP", "a stream that went on for 1 s");
    }
    const Exchange* sent = nullptr;
    const Exchange* answered = nullptr;
    for (std::size_t i = 0; i < std::min(dialogue.first_start, dialogue.entries().size()); ++i) {
        const TranscriptEntry& entry = dialogue.entry(i);
        if (entry.kind != Kind::frame) { continue; }
        findings.looked();
        const auto reply = reply_in(entry);
        for (const auto& exchange : dialogue.exchanges) {
            if (!exchange) { continue; }
            if (exchange->sent <= i && (sent == nullptr || exchange->sent >= sent->sent)) {
                sent = &*exchange;
            }
            if (reply && exchange->number == reply->command_sequence) { answered = &*exchange; }
        }
        const auto explained = [&](const Exchange* by) {
            return by != nullptr && belongs_to_answer(by->type, entry.type);
        };
        if (entry.type >= glp_frame_hello && entry.type <= glp_frame_status && !explained(sent) &&
            !explained(answered)) {
            findings.wrong("before the first start only what a command asked for", name_of_type(entry.type),
                           &entry);
        }
    }
    return findings.judgement(why_not_asked(dialogue, "nothing came"));
}

constexpr std::array all_device_rules{
    Rule{"8.1", "A rising DTR brings HELLO, CONFIG, EVENT started, SAMPLES", rising_dtr},
    Rule{"8.2", "A falling DTR brings EVENT stopped, then nothing", falling_dtr},
    Rule{"8.3", "START and STOP do the same without DTR", start_and_stop},
    Rule{"8.4", "Each command is answered by one REPLY", replies},
    Rule{"8.5", "A CONFIGURE is told by the next CONFIG, and restarts a stream", configuring},
    Rule{"8.6", "HELLO and CONFIG come every 5 s, STATUS every 1 s", rhythm},
    Rule{"8.7", "A frame that finds no room is dropped whole and told", ring_overflow},
    Rule{"8.8", "No sample waits longer than 100 ms for its frame", patience},
    Rule{"8.9", "The device chooses about 40 ms of samples a frame", chosen_samples},
    Rule{"8.10", "Every loss is flagged", losses},
    Rule{"8.11", "A sensor that does not answer right is told", sensor_fault},
    Rule{"8.12", "The set-up at boot is the agreed one", setup_at_boot},
    Rule{"10.5", "Nothing comes before the first start but answers", silent_until_asked},
};

}  // namespace

std::span<const Rule> device_rules() { return all_device_rules; }

}  // namespace gyrolog
