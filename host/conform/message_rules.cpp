#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include <fmt/format.h>
#include <gyrolog_protocol/version.h>

#include "firmware_protocol/device/mpu9250.h"
#include "host/conform/rule.hpp"

namespace gyrolog {
namespace {

using Kind = TranscriptEntry::Kind;

constexpr double scale_tolerance = 0.02;
constexpr double slack_s = 0.15;  // of a sample's way into a frame: 100 ms, and the main loop's pause

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<std::uint8_t>(text[i++]);
        const unsigned more = lead < 0x80   ? 0
                              : lead < 0xC2 ? 4
                              : lead < 0xE0 ? 1
                              : lead < 0xF0 ? 2
                              : lead < 0xF5 ? 3
                                            : 4;
        if (more > 3 || text.size() - i < more) { return false; }
        for (unsigned k = 0; k < more; ++k) {
            if ((static_cast<std::uint8_t>(text[i++]) & 0xC0U) != 0x80) { return false; }
        }
    }
    return true;
}

// ---------------------------------------------------------------------------------------- all of the
// messages

bool later_minor(const Dialogue& dialogue) {
    const auto hello = dialogue.hello();
    return hello && hello->protocol_minor > GLP_PROTOCOL_MINOR;
}

Judgement known_types(const Dialogue& dialogue) {
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (entry.kind != Kind::frame) { continue; }
        findings.looked();
        const bool known = entry.type >= glp_frame_hello && entry.type <= glp_frame_reply;
        const bool later = entry.type < 0x80 && later_minor(dialogue);
        if (!known && !later) {
            findings.wrong("types 01 to 06 from a device of version 1.0", name_of_type(entry.type), &entry);
        }
    }
    return findings.judgement("no frame came");
}

// By the rule that has the message's table.
Judgement ill_formed(const Dialogue& dialogue, unsigned type, const char* expected) {
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (!entry.is_frame(type)) { continue; }
        findings.looked();
        if (entry.status != glp_status_ok) {
            findings.wrong(
                expected,
                fmt::format("{}: {} bytes of payload", glp_status_name(entry.status), entry.payload.size()),
                &entry);
        }
    }
    return findings.judgement(fmt::format("no {} came", name_of_type(type)));
}

struct Reserved {
    unsigned type;
    std::size_t first;
    std::size_t bytes;
};

constexpr std::array<Reserved, 4> reserved_fields = {{{glp_frame_hello, 13, 3},
                                                      {glp_frame_samples, 26, 2},
                                                      {glp_frame_event, 19, 1},
                                                      {glp_frame_reply, 6, 2}}};

Judgement lengths_and_reserved(const Dialogue& dialogue) {
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (entry.kind != Kind::frame) { continue; }
        for (const Reserved& field : reserved_fields) {
            if (entry.type != field.type || entry.payload.size() < field.first + field.bytes) { continue; }
            findings.looked();
            for (std::size_t i = field.first; i < field.first + field.bytes; ++i) {
                if (entry.payload[i] == 0) { continue; }
                findings.wrong(fmt::format("0 in the reserved byte {} of {}", i, name_of_type(entry.type)),
                               fmt::format("{:02x}", entry.payload[i]), &entry);
            }
        }
    }
    const auto& brief = dialogue.asked(Ask::short_configure);
    if (brief && brief->answer) {
        findings.looked();
        if (brief->answer->result != glp_result_bad_length) {
            findings.wrong("REPLY bad_length to a CONFIGURE of 8 bytes",
                           fmt::format("REPLY {}", name_of_result(brief->answer->result)),
                           &dialogue.entry(*brief->reply));
        }
    }
    const auto& longer = dialogue.asked(Ask::long_hello);
    if (longer && dialogue.answers_commands()) {
        findings.looked();
        if (!longer->answer || longer->answer->result != glp_result_ok) {
            findings.wrong("REPLY ok to a GET_HELLO with 4 bytes that a later version may have",
                           longer->answer ? fmt::format("REPLY {}", name_of_result(longer->answer->result))
                                          : "no answer",
                           longer->reply ? &dialogue.entry(*longer->reply) : nullptr);
        }
    }
    return findings.judgement("no frame came");
}

// -------------------------------------------------------------------------------------------------- SAMPLES

Judgement samples_values(const Dialogue& dialogue) {
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (!entry.is_frame(glp_frame_samples)) { continue; }
        findings.looked();
        if (entry.status != glp_status_bad_value) { continue; }
        findings.wrong("a count of 1 or more, and a layout of the bits 01, 02 and 04",
                       fmt::format("count {}, layout {:02x}", entry.payload[24], entry.payload[25]), &entry);
    }
    return findings.judgement("no SAMPLES came");
}

Judgement samples_length(const Dialogue& dialogue) {
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (!entry.is_frame(glp_frame_samples)) { continue; }
        findings.looked();
        if (entry.status != glp_status_bad_length) { continue; }
        findings.wrong("28 bytes and count x bytes of a sample",
                       fmt::format("{} bytes of payload", entry.payload.size()), &entry);
    }
    return findings.judgement("no SAMPLES came");
}

Judgement one_configuration(const Dialogue& dialogue) {
    Findings findings;
    for (const Run& run : dialogue.runs) {
        if (!run.config) { continue; }
        for (std::size_t i = run.entries.begin; i < run.entries.end; ++i) {
            const auto samples = samples_in(dialogue.entry(i));
            if (!samples) { continue; }
            findings.looked();
            if (samples->config_generation != run.config->generation ||
                samples->layout != run.config->layout || samples->count > run.config->samples_per_frame) {
                findings.wrong(
                    fmt::format("generation {}, layout {:02x}, at most {} samples: the CONFIG in force",
                                run.config->generation, run.config->layout, run.config->samples_per_frame),
                    fmt::format("generation {}, layout {:02x}, {} samples", samples->config_generation,
                                samples->layout, samples->count),
                    &dialogue.entry(i));
            }
        }
    }
    return findings.judgement("no SAMPLES came, or no CONFIG");
}

bool holds_end_of_range(const glp_samples& samples) {
    const std::size_t fields =
        glp_sample_bytes(samples.layout) / 2 - ((samples.layout & glp_layout_temperature) != 0 ? 1 : 0);
    for (std::size_t i = 0; i < samples.count; ++i) {
        for (std::size_t field = 0; field < fields; ++field) {
            const std::int16_t count = glp_sample_field(&samples, i, field);
            if (count == INT16_MAX || count == INT16_MIN) { return true; }
        }
    }
    return false;
}

Judgement sample_flags(const Dialogue& dialogue) {
    Findings findings;
    for (const Run& run : dialogue.runs) {
        bool first = true;
        for (std::size_t i = run.entries.begin; i < run.entries.end; ++i) {
            const TranscriptEntry& entry = dialogue.entry(i);
            const auto samples = samples_in(entry);
            if (!samples) { continue; }
            findings.looked();
            const bool told_first = (entry.flags & glp_flag_first_after_start) != 0;
            if (told_first != first) {
                findings.wrong(first ? "flag first_after_start in the first frame after the start"
                                     : "no flag first_after_start but in the first frame",
                               fmt::format("flags {:04x}", entry.flags), &entry);
            }
            const bool told_saturated = (entry.flags & glp_flag_saturated) != 0;
            if (told_saturated != holds_end_of_range(*samples)) {
                findings.wrong(told_saturated ? "no flag saturated: no count is 7fff or 8000"
                                              : "flag saturated: a count is 7fff or 8000",
                               fmt::format("flags {:04x}", entry.flags), &entry);
            }
            first = false;
        }
    }
    return findings.judgement("no SAMPLES came");
}

// ------------------------------------------------------------------------------------------ HELLO and CONFIG

bool padded(const TranscriptEntry& entry, std::size_t first, std::size_t bytes) {
    const auto begin = entry.payload.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(bytes);
    return std::all_of(std::find(begin, end, 0), end, [](std::uint8_t byte) { return byte == 0; });
}

// All but boot_id, which has a rule of its own, and the sensor: one that did not answer may answer later.
bool same_device(const TranscriptEntry& a, const TranscriptEntry& b) {
    return std::equal(a.payload.begin(), a.payload.begin() + 3, b.payload.begin()) &&
           std::equal(a.payload.begin() + 4, a.payload.begin() + 8, b.payload.begin() + 4) &&
           std::equal(a.payload.begin() + 12, a.payload.begin() + 56, b.payload.begin() + 12);
}

Judgement hello_rule(const Dialogue& dialogue) {
    Judgement form = ill_formed(dialogue, glp_frame_hello,
                                "72 bytes; major version not 0, tick_bits 32 to 64, tick_hz not 0");
    if (form.state != JudgementState::pass) { return form; }
    Findings findings;
    const TranscriptEntry* first = nullptr;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        const auto hello = hello_in(entry);
        if (!hello) { continue; }
        findings.looked();
        if (!padded(entry, 32, GLP_FIRMWARE_BYTES) || !padded(entry, 56, GLP_SENSOR_BYTES)) {
            findings.wrong("texts padded with 00", "other bytes behind a text's 00", &entry);
        } else if (!is_utf8(hello->firmware) || !is_utf8(hello->sensor)) {
            findings.wrong("texts in UTF-8", "bytes that are none", &entry);
        } else if (hello->reset_cause > glp_reset_software && !later_minor(dialogue)) {
            findings.wrong("reset_cause 0 to 5", std::to_string(hello->reset_cause), &entry);
        }
        if (first == nullptr) { first = &entry; }
        if (!same_device(*first, entry)) {
            findings.wrong("the same HELLO each time", "another one", &entry);
        }
    }
    return findings.judgement("no HELLO came");
}

unsigned dlpf_cfg_of(unsigned dlpf_hz) {
    constexpr std::array<unsigned, 8> bandwidths = {250, 184, 92, 41, 20, 10, 5, 3600};
    const auto found = std::find(bandwidths.begin(), bandwidths.end(), dlpf_hz);
    return found == bandwidths.end() ? 0U : static_cast<unsigned>(found - bandwidths.begin());
}

// By the register map; empty when the registers say what the fields say.
std::string register_refusal(const glp_config& config) {
    const std::uint8_t* registers = config.registers;
    const unsigned gyro_range = 250U << ((registers[2] >> 3U) & 3U);
    const unsigned accel_range = 2U << ((registers[3] >> 3U) & 3U);
    if (gyro_range != config.gyro_full_scale_dps) {
        return fmt::format("GYRO_CONFIG says {} dps", gyro_range);
    }
    if (accel_range != config.accel_full_scale_g) {
        return fmt::format("ACCEL_CONFIG says {} g", accel_range);
    }
    const bool bypassed = (registers[2] & 3U) != 0;
    if (bypassed != (config.dlpf_hz == 0)) { return "GYRO_CONFIG's Fchoice_b says otherwise of the filter"; }
    if (!bypassed && (registers[1] & 7U) != dlpf_cfg_of(config.dlpf_hz)) {
        return "CONFIG's DLPF_CFG says another bandwidth";
    }
    const bool divides = !bypassed && (registers[1] & 7U) >= 1 && (registers[1] & 7U) <= 6;
    const double rate_Hz = 1000.0 / (1.0 + registers[0]);
    if (divides && std::fabs(rate_Hz - config.rate_mHz * 1e-3) > 0.001) {
        return fmt::format("SMPLRT_DIV says {:.3f} Hz", rate_Hz);
    }
    return {};
}

bool off_scale(double full_scale, double per_lsb) {
    return std::fabs(full_scale / 32768.0 / per_lsb - 1.0) > scale_tolerance;
}

Judgement config_rule(const Dialogue& dialogue) {
    Judgement form = ill_formed(dialogue, glp_frame_config,
                                "40 bytes; samples_per_frame, rate, decimation and scales not 0");
    if (form.state != JudgementState::pass) { return form; }
    const auto hello = dialogue.hello();
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        const auto config = config_in(entry);
        if (!config) { continue; }
        findings.looked();
        if (off_scale(config->gyro_full_scale_dps * 1e9, config->gyro_ndps_per_lsb)) {
            findings.wrong(fmt::format("a count of about {} / 32768 °/s", config->gyro_full_scale_dps),
                           fmt::format("{} n°/s", config->gyro_ndps_per_lsb), &entry);
        } else if (off_scale(config->accel_full_scale_g * 1e12, config->accel_pg_per_lsb)) {
            findings.wrong(fmt::format("a count of about {} / 32768 g", config->accel_full_scale_g),
                           fmt::format("{} pg", config->accel_pg_per_lsb), &entry);
        } else if (config->samples_per_frame > glp_samples_per_frame_max(config->layout)) {
            findings.wrong("samples_per_frame that fit a frame", std::to_string(config->samples_per_frame),
                           &entry);
        } else if (hello && glp_mpu_name(hello->who_am_i) != nullptr) {
            const std::string refusal = register_refusal(*config);
            if (!refusal.empty()) {
                findings.wrong("registers that say what the fields say", refusal, &entry);
            }
        }
    }
    return findings.judgement("no CONFIG came");
}

Judgement decimation(const Dialogue& dialogue) {
    Findings findings;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        const auto config = config_in(entry);
        if (!config) { continue; }
        const bool whole_kilohertz =
            config->dlpf_hz != 0 && config->dlpf_hz != 250 && config->dlpf_hz != 3600;
        const double inside_Hz = config->dlpf_hz == 0 ? 32000.0
                                 : whole_kilohertz    ? config->rate_mHz * 1e-3
                                                      : 8000.0;
        const double expected = std::round(inside_Hz * 1e3 / config->rate_mHz);
        if (!whole_kilohertz) { findings.looked(); }
        if (config->decimation != expected) {
            findings.wrong(
                fmt::format("decimation {:g}: the sensor makes {:g} Hz inside", expected, inside_Hz),
                std::to_string(config->decimation), &entry);
        }
    }
    return findings.judgement("the device refused a rate at which samples are left out");
}

// ---------------------------------------------------------------------------------- STATUS, EVENT and REPLY

// What SAMPLES say of the run so far, at a place of the transcript.
struct RunSoFar {
    bool streaming = false;
    std::uint64_t sent_to = 0;  // one behind the last index that was sent
    const glp_config* config = nullptr;
};

Judgement status_rule(const Dialogue& dialogue) {
    Judgement form = ill_formed(dialogue, glp_frame_status, "48 bytes; streaming 0 or 1");
    if (form.state != JudgementState::pass) { return form; }
    Findings findings;
    RunSoFar now;
    bool told_to_stop = false;
    std::size_t next_run = 0;
    for (std::size_t i = 0; i < dialogue.entries().size(); ++i) {
        const TranscriptEntry& entry = dialogue.entry(i);
        if (next_run < dialogue.runs.size() && i == dialogue.runs[next_run].entries.begin) {
            now = {false, 0, dialogue.runs[next_run].config ? &*dialogue.runs[next_run].config : nullptr};
            ++next_run;
            told_to_stop = false;
        }
        if (const auto samples = samples_in(entry)) {
            now.streaming = !told_to_stop;
            now.sent_to = samples->first_index + samples->count;
        }
        const auto event = event_in(entry);
        const auto reply = reply_in(entry);
        told_to_stop = told_to_stop || (entry.kind == Kind::line && !entry.raised) ||
                       (reply && reply->command_type == glp_frame_stop);
        if (told_to_stop || (event && event->code == glp_event_stopped)) { now.streaming = false; }
        const auto status = status_in(entry);
        if (!status) { continue; }
        findings.looked();
        if (status->ring_high_water_bytes > status->ring_bytes) {
            findings.wrong(fmt::format("ring_high_water_bytes of at most {}", status->ring_bytes),
                           std::to_string(status->ring_high_water_bytes), &entry);
        }
        if (next_run == 0 && status->streaming != 0) {
            findings.wrong("streaming 0 before any start", "1", &entry);
        }
        if (!now.streaming) { continue; }
        if (status->streaming == 0) { findings.wrong("streaming 1 while SAMPLES come", "0", &entry); }
        const double waiting =
            now.config == nullptr ? 1e9
                                  : now.config->samples_per_frame + now.config->rate_mHz * 1e-3 * slack_s + 2;
        if (status->next_index < now.sent_to ||
            static_cast<double>(status->next_index - now.sent_to) > waiting) {
            findings.wrong(
                fmt::format("next_index {} or somewhat more: up to there samples were sent", now.sent_to),
                std::to_string(status->next_index), &entry);
        }
    }
    return findings.judgement("no STATUS came");
}

Judgement event_rule(const Dialogue& dialogue) {
    Findings findings;
    std::uint32_t lost = 0;
    for (const TranscriptEntry& entry : dialogue.entries()) {
        if (const auto samples = samples_in(entry)) { lost = samples->lost_samples; }
        const auto event = event_in(entry);
        if (!event) { continue; }
        findings.looked();
        if ((event->code == 0 || event->code > glp_event_data_ready_silent) && !later_minor(dialogue)) {
            findings.wrong("codes 1 to 8 from a device of version 1.1", std::to_string(event->code), &entry);
        }
        if (event->code == glp_event_started) {
            if (event->value != 0) {
                findings.wrong("value 0 in EVENT started", std::to_string(event->value), &entry);
            }
            lost = 0;
        }
        if (event->code == glp_event_stopped && event->value != static_cast<std::int64_t>(lost)) {
            // What could not be read any more when it stopped is in no frame before.
            if (event->value < static_cast<std::int64_t>(lost) ||
                event->value > static_cast<std::int64_t>(lost) + 64) {
                findings.wrong(fmt::format("samples lost since the start in EVENT stopped: {}", lost),
                               std::to_string(event->value), &entry);
            }
        }
        if (!is_utf8({event->text, event->text_bytes})) {
            findings.wrong("text in UTF-8", "bytes that are none", &entry);
        }
    }
    return findings.judgement("no EVENT came");
}

Judgement event_text(const Dialogue& dialogue) {
    return ill_formed(dialogue, glp_frame_event, "text_bytes of at most 96, and as many bytes behind the 24");
}

Judgement reply_rule(const Dialogue& dialogue) {
    Judgement form = ill_formed(dialogue, glp_frame_reply, "8 bytes");
    if (form.state != JudgementState::pass) { return form; }
    Findings findings;
    for (std::size_t i = 0; i < dialogue.exchanges.size(); ++i) {
        const auto& exchange = dialogue.exchanges[i];
        const auto ask = static_cast<Ask>(i);
        // Those that must not be answered have rules of their own.
        if (ask == Ask::echo || ask == Ask::bad_checksum || ask == Ask::other_version) { continue; }
        if (!exchange || !exchange->reply) { continue; }
        findings.looked();
        if (exchange->answer->command_type != exchange->type) {
            findings.wrong(fmt::format("command_type {:02x}, of the command answered", exchange->type),
                           fmt::format("{:02x}", exchange->answer->command_type),
                           &dialogue.entry(*exchange->reply));
        }
        if (exchange->answer->result > glp_result_sensor_fault && !later_minor(dialogue)) {
            findings.wrong("result 0 to 4", std::to_string(exchange->answer->result),
                           &dialogue.entry(*exchange->reply));
        }
    }
    return findings.judgement("no command is answered");
}

// --------------------------------------------------------------------------------------------------
// CONFIGURE

std::optional<std::pair<glp_config, std::size_t>> config_in_answer(const Dialogue& dialogue,
                                                                   const Exchange& exchange) {
    for (std::size_t i = *exchange.reply; i < exchange.end; ++i) {
        if (const auto config = config_in(dialogue.entry(i))) { return std::pair{*config, i}; }
    }
    return std::nullopt;
}

bool accepted(const std::optional<Exchange>& exchange) {
    return exchange && exchange->answer && exchange->answer->result == glp_result_ok;
}

// A field that was asked for, or left.
bool as_asked(unsigned asked, unsigned before, unsigned now) { return now == (asked != 0 ? asked : before); }

std::string told(const glp_config& config) {
    return fmt::format("{:g} Hz, {} °/s, {} g, filter {} Hz, layout {:02x}", config.rate_mHz * 1e-3,
                       config.gyro_full_scale_dps, config.accel_full_scale_g, config.dlpf_hz, config.layout);
}

Judgement configure_is_obeyed(const Dialogue& dialogue) {
    Findings findings;
    for (const Ask ask : {Ask::rate_slow, Ask::rate_third, Ask::rate_kilohertz, Ask::one_field, Ask::standard,
                          Ask::configure_streaming, Ask::decimated}) {
        const auto& exchange = dialogue.asked(ask);
        if (!accepted(exchange)) { continue; }
        const auto now = config_in_answer(dialogue, *exchange);
        const auto before = dialogue.last_config_before(*exchange->reply);
        if (!now || !before) { continue; }
        findings.looked();
        const AskedSettings& wanted = exchange->configure;
        const glp_config& config = now->first;
        const bool filter =
            as_asked(wanted.dlpf_hz == GLP_DLPF_OFF ? 0U : wanted.dlpf_hz, before->dlpf_hz, config.dlpf_hz);
        const bool samples =
            wanted.samples_per_frame == 0 || config.samples_per_frame == wanted.samples_per_frame;
        if (!as_asked(wanted.rate_mHz, before->rate_mHz, config.rate_mHz) || !filter || !samples ||
            !as_asked(wanted.gyro_full_scale_dps, before->gyro_full_scale_dps, config.gyro_full_scale_dps) ||
            !as_asked(wanted.accel_full_scale_g, before->accel_full_scale_g, config.accel_full_scale_g) ||
            !as_asked(wanted.layout, before->layout, config.layout)) {
            findings.wrong(
                fmt::format(
                    "a CONFIG with what was asked ({:g} Hz, {} °/s, {} g, filter {} Hz, layout {:02x}, {} "
                    "samples a frame; 0 leaves it) over {}",
                    wanted.rate_mHz * 1e-3, wanted.gyro_full_scale_dps, wanted.accel_full_scale_g,
                    wanted.dlpf_hz, wanted.layout, wanted.samples_per_frame, told(*before)),
                fmt::format("{}, {} samples a frame", told(config), config.samples_per_frame),
                &dialogue.entry(now->second));
        }
    }
    return findings.judgement(why_not_asked(dialogue, "no CONFIGURE was accepted"));
}

Judgement rates(const Dialogue& dialogue) {
    Findings findings;
    const TranscriptEntry* refusal = nullptr;
    std::uint32_t refused_mHz = 0;
    for (const Ask ask : {Ask::rate_slow, Ask::standard, Ask::rate_third, Ask::rate_kilohertz}) {
        const auto& exchange = dialogue.asked(ask);
        if (!exchange || !exchange->answer) { continue; }
        findings.looked();
        if (exchange->answer->result == glp_result_bad_value) {
            if (refusal == nullptr) { refused_mHz = exchange->configure.rate_mHz; }
            refusal = &dialogue.entry(*exchange->reply);
        } else if (refusal != nullptr) {
            findings.wrong(fmt::format("{:g} Hz taken like the faster {:g} Hz", refused_mHz * 1e-3,
                                       exchange->configure.rate_mHz * 1e-3),
                           "REPLY bad_value", refusal);
            refusal = nullptr;
        }
    }
    return findings.judgement(why_not_asked(dialogue, "no CONFIGURE was answered"));
}

Judgement bad_values(const Dialogue& dialogue) {
    Findings findings;
    for (const Ask ask : {Ask::bad_full_scale, Ask::bad_combination, Ask::bad_layout, Ask::too_many_samples,
                          Ask::refused_streaming}) {
        const auto& exchange = dialogue.asked(ask);
        if (!exchange || !exchange->answer) { continue; }
        findings.looked();
        if (exchange->answer->result != glp_result_bad_value) {
            findings.wrong("REPLY bad_value to a CONFIGURE that the sensor cannot do",
                           fmt::format("REPLY {}", name_of_result(exchange->answer->result)),
                           &dialogue.entry(*exchange->reply));
        }
    }
    const auto& after = dialogue.asked(Ask::hello_after_refusals);
    const auto& before = dialogue.asked(Ask::hello);
    if (after && after->reply && before && before->reply &&
        findings.judgement({}).state == JudgementState::pass) {
        const auto was = config_in_answer(dialogue, *before);
        const auto now = config_in_answer(dialogue, *after);
        const auto& damaged = dialogue.asked(Ask::bad_checksum);
        const auto& foreign = dialogue.asked(Ask::other_version);
        // Whoever obeys a damaged command has broken another rule.
        const bool obeyed = (damaged && damaged->reply) || (foreign && foreign->reply);
        if (was && now && !obeyed &&
            dialogue.entry(was->second).payload != dialogue.entry(now->second).payload) {
            findings.wrong("the same CONFIG after refused CONFIGUREs: " + told(was->first), told(now->first),
                           &dialogue.entry(now->second));
        }
    }
    return findings.judgement(why_not_asked(dialogue, "no CONFIGURE was answered"));
}

constexpr std::array all_message_rules{
    Rule{"4.1", "The device sends the types that are its own", known_types},
    Rule{"4.2", "Reserved bytes are 0; short commands are refused, long ones taken", lengths_and_reserved},
    Rule{"4.3.1", "SAMPLES have a known layout and at least one sample", samples_values},
    Rule{"4.3.2", "SAMPLES have exactly the length of their samples", samples_length},
    Rule{"4.3.3", "The samples of a frame are of the configuration in force", one_configuration},
    Rule{"4.3.4", "The flags of SAMPLES say what happened", sample_flags},
    Rule{"4.4", "HELLO says who the device is, the same each time", hello_rule},
    Rule{"4.5", "CONFIG's ranges, scales and registers agree", config_rule},
    Rule{"4.5.2", "CONFIG tells when samples are left out", decimation},
    Rule{"4.6", "STATUS agrees with the stream", status_rule},
    Rule{"4.7", "EVENTs have known codes and the right values", event_rule},
    Rule{"4.7.1", "EVENT's text has the length that it says", event_text},
    Rule{"4.8", "REPLY names the command and a result", reply_rule},
    Rule{"4.9", "CONFIG shows what CONFIGURE asked for, and leaves the rest", configure_is_obeyed},
    Rule{"4.9.1", "The rates of the sensor are there", rates},
    Rule{"4.9.2", "What the sensor does not have is refused, and nothing changes", bad_values},
};

}  // namespace

std::span<const Rule> message_rules() { return all_message_rules; }

}  // namespace gyrolog
