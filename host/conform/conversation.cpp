#include "host/conform/conversation.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include <gyrolog_protocol/version.h>

#include "host/conform/probe.hpp"
#include "host/transport/raw_frame.hpp"

namespace gyrolog {
namespace {

constexpr double settle_s = 0.05;  // silence that counts as stopped (SPEC.md, 9.5)
constexpr double settle_limit_s = 1.0;
constexpr double stopping_s = 1.0;
constexpr double listen_s = 0.3;     // for what must not come
constexpr double quiet_run_s = 6.8;  // of device time: a HELLO every 5 s, a third late
constexpr double short_run_s = 0.6;
constexpr double silence_is_end_s = 2.0;  // a stream that pauses for so long has ended
constexpr double held_up_silence_s = 0.05;
constexpr unsigned unanswered_max = 3;  // in a row: the device answers nothing
constexpr std::size_t overlong_bytes = 3000;
constexpr unsigned type_unknown_command = 0xF0;

// By hand: the codec does not write what a device must refuse.
Bytes payload_of(const AskedSettings& asked) {
    Bytes payload;
    const auto put = [&payload](std::uint32_t value, unsigned bytes) {
        for (unsigned i = 0; i < bytes; ++i) {
            payload.push_back(static_cast<std::uint8_t>(value >> (8U * i)));
        }
    };
    put(asked.rate_mHz, 4);
    put(asked.gyro_full_scale_dps, 2);
    put(asked.accel_full_scale_g, 2);
    put(asked.dlpf_hz, 2);
    put(asked.layout, 1);
    put(asked.samples_per_frame, 1);
    put(0, 4);
    return payload;
}

// Device time that the stretch's stamps cover, by the tick rate that HELLO tells.
class DeviceTime {
public:
    explicit DeviceTime(std::size_t from) : from_(from) {}

    double covered_s(const Transcript& transcript) {
        const auto& entries = transcript.entries();
        for (; next_ < entries.size(); ++next_) {
            if (const auto hello = hello_in(entries[next_])) {
                tick_hz_ = hello->tick_hz;
                tick_mask_ =
                    hello->tick_bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << hello->tick_bits) - 1;
            }
            const auto samples = samples_in(entries[next_]);
            if (!samples || next_ < from_ || tick_hz_ == 0) { continue; }
            if (last_) {
                const std::uint64_t step = (samples->first_ticks - *last_) & tick_mask_;
                // A step backward is for the rules to judge.
                if (step <= tick_mask_ / 2) { covered_s_ += static_cast<double>(step) / tick_hz_; }
            }
            last_ = samples->first_ticks;
        }
        return covered_s_;
    }

private:
    const std::size_t from_;
    std::size_t next_ = 0;
    std::uint32_t tick_hz_ = 0;
    std::uint64_t tick_mask_ = ~std::uint64_t{0};
    std::optional<std::uint64_t> last_;
    double covered_s_ = 0.0;
};

class Conversation {
public:
    Conversation(ByteSource& source, const std::function<bool()>& go_on)
        : source_(source), probe_(source, go_on), go_on_(go_on) {}

    Result<Dialogue> run() {
        GYROLOG_CHECK(probe_.start());
        GYROLOG_CHECK(settle());
        const Status spoken = speak();
        probe_.finish();
        restore();
        probe_.stop();
        if (!spoken.ok()) { return spoken.error(); }
        if (probe_.transcript().bytes_received() == 0) {
            return Error{ErrorCode::timeout, source_.identity().uri + ": nothing came, whatever was asked"};
        }
        dialogue_.identity = source_.identity();
        dialogue_.held_up = probe_.held_up();
        dialogue_.transcript = probe_.transcript();
        dialogue_.on_usb = dialogue_.identity.uri.starts_with("usb:");
        complete();
        return std::move(dialogue_);
    }

private:
    // ------------------------------------------------------------------------------------- the parts, in
    // order

    Status settle() {
        Status lowered = probe_.set_line_state(false);
        if (!lowered.ok() && lowered.error().code != ErrorCode::unsupported) { return lowered; }
        dialogue_.has_line = lowered.ok();
        // A board that a program before left streaming on a command stops on one. What an earlier listener
        // left on the line is gone with it, and so is a command that was cut short.
        GYROLOG_CHECK(probe_.write(Bytes(2, 0)));
        GYROLOG_CHECK(stop_what_runs());
        if (!dialogue_.has_line) { GYROLOG_CHECK(stop_what_runs()); }
        dialogue_.never_quiet =
            !probe_.await_silence(probe_.held_up() ? held_up_silence_s : 4 * settle_s, settle_limit_s);
        probe_.forget();
        return {};
    }

    // A line that was just opened may take a second until it carries anything. An answer is not asked for
    // yet.
    Status stop_what_runs() {
        GYROLOG_CHECK(probe_.write(probe_.command(glp_frame_stop, {})));
        static_cast<void>(probe_.await_reply(probe_.last_number()));
        return {};
    }

    Status speak() {
        GYROLOG_CHECK(listen_for_nothing());
        GYROLOG_CHECK(ask_while_stopped());
        GYROLOG_CHECK(ask_what_it_must_refuse());
        GYROLOG_CHECK(ask_for_settings());
        GYROLOG_CHECK(first_run());
        return second_run();
    }

    Status ask_while_stopped() {
        GYROLOG_CHECK(ask(Ask::hello, glp_frame_get_hello));
        GYROLOG_CHECK(ask(Ask::status, glp_frame_get_status));
        GYROLOG_CHECK(ask(Ask::unknown_type, type_unknown_command));
        original_ = latest_config();
        GYROLOG_CHECK(
            ask_unanswered(Ask::echo, probe_.command(glp_frame_status, Bytes(48, 0)), glp_frame_status));

        const AskedSettings change{.gyro_full_scale_dps = 2000};
        RawFrame forged{
            .type = glp_frame_configure, .sequence = probe_.take_number(), .payload = payload_of(change)};
        GYROLOG_CHECK(ask_unanswered(Ask::bad_checksum, forged.wire(0x01010101), glp_frame_configure));
        forged.version = GLP_PROTOCOL_MAJOR + 1;
        forged.sequence = probe_.take_number();
        GYROLOG_CHECK(ask_unanswered(Ask::other_version, forged.wire(), glp_frame_configure));
        GYROLOG_CHECK(ask(Ask::short_configure, glp_frame_configure, Bytes(8, 0)));
        GYROLOG_CHECK(ask(Ask::long_hello, glp_frame_get_hello, Bytes{1, 2, 3, 4}));
        return ask_in_odd_ways();
    }

    Status ask_in_odd_ways() {
        // The closing delimiter of the first opens the second.
        Bytes two = probe_.command(glp_frame_get_status, {});
        const Bytes second = probe_.command(glp_frame_get_status, {});
        two.insert(two.end(), second.begin() + 1, second.end());
        GYROLOG_CHECK(ask_raw(Ask::shared_delimiter, {two}, glp_frame_get_status));

        Bytes many(7, 0);
        append(many, probe_.command(glp_frame_get_status, {}));
        many.insert(many.end(), 5, 0);
        GYROLOG_CHECK(ask_raw(Ask::many_delimiters, {many}, glp_frame_get_status));

        std::vector<Bytes> pieces;
        for (const std::uint8_t byte : probe_.command(glp_frame_get_status, {})) { pieces.push_back({byte}); }
        GYROLOG_CHECK(ask_raw(Ask::in_pieces, pieces, glp_frame_get_status));

        Bytes noise = {0x55, 0xAA, 0x31, 0xFF, 0x07};
        append(noise, probe_.command(glp_frame_get_status, {}));
        GYROLOG_CHECK(ask_raw(Ask::after_noise, {noise}, glp_frame_get_status));

        Bytes damage = probe_.command(glp_frame_configure, payload_of({.gyro_full_scale_dps = 2000}));
        damage.erase(damage.begin() + 4);
        append(damage, probe_.command(glp_frame_get_status, {}));
        GYROLOG_CHECK(ask_raw(Ask::after_damage, {damage}, glp_frame_get_status));

        // In portions that a UART's driver takes at once.
        std::vector<Bytes> overlong(overlong_bytes / 250, Bytes(250, 0x2A));
        overlong.push_back(probe_.command(glp_frame_get_status, {}));
        return ask_raw(Ask::after_overlong, overlong, glp_frame_get_status);
    }

    Status ask_what_it_must_refuse() {
        GYROLOG_CHECK(configure(Ask::bad_full_scale, {.gyro_full_scale_dps = 300}));
        GYROLOG_CHECK(configure(Ask::bad_combination, {.rate_mHz = 999'000, .accel_full_scale_g = 2}));
        GYROLOG_CHECK(configure(Ask::bad_layout, {.layout = 0x08}));
        GYROLOG_CHECK(configure(Ask::too_many_samples, {.layout = 3, .samples_per_frame = 255}));
        GYROLOG_CHECK(ask(Ask::hello_after_refusals, glp_frame_get_hello));
        return ask(Ask::stop_while_stopped, glp_frame_stop);
    }

    Status ask_for_settings() {
        GYROLOG_CHECK(configure(Ask::rate_slow, {.rate_mHz = 3906, .dlpf_hz = 41}));
        GYROLOG_CHECK(
            configure(Ask::rate_third, {.rate_mHz = 333'333, .dlpf_hz = 41, .samples_per_frame = 10}));
        GYROLOG_CHECK(configure(Ask::rate_kilohertz, {.rate_mHz = 1'000'000, .dlpf_hz = 41}));
        GYROLOG_CHECK(configure(Ask::one_field, {.gyro_full_scale_dps = 1000}));
        return configure(Ask::standard, {.rate_mHz = 100'000,
                                         .gyro_full_scale_dps = 500,
                                         .accel_full_scale_g = 8,
                                         .dlpf_hz = 41,
                                         .layout = glp_layout_gyro | glp_layout_accel});
    }

    Status first_run() {
        dialogue_.first_start = probe_.entry_count();
        GYROLOG_CHECK(begin_run(Ask::start));
        const std::size_t begin = probe_.entry_count();
        GYROLOG_CHECK(stream_for(quiet_run_s, begin_of_run_));
        dialogue_.quiet_run = Passage{begin_of_run_, std::max(begin, probe_.entry_count())};
        GYROLOG_CHECK(ask(Ask::start_again, glp_frame_start));
        GYROLOG_CHECK(ask(Ask::hello_streaming, glp_frame_get_hello));
        GYROLOG_CHECK(ask(Ask::status_streaming, glp_frame_get_status));
        GYROLOG_CHECK(configure(Ask::refused_streaming, {.gyro_full_scale_dps = 300}));
        GYROLOG_CHECK(ask(Ask::unknown_streaming, type_unknown_command));
        GYROLOG_CHECK(stream_for(short_run_s / 2, probe_.entry_count()));
        GYROLOG_CHECK(configure(Ask::configure_streaming,
                                {.rate_mHz = 20'000, .dlpf_hz = 41, .samples_per_frame = 20}));
        begin_configured_run();
        GYROLOG_CHECK(stream_for(2 * short_run_s, begin_of_run_));
        return end_run();
    }

    Status second_run() {
        GYROLOG_CHECK(ask(Ask::status_stopped, glp_frame_get_status));
        GYROLOG_CHECK(
            configure(Ask::decimated, {.rate_mHz = 200'000, .dlpf_hz = 250, .layout = glp_layout_gyro}));
        if (dialogue_.has_line) {
            GYROLOG_CHECK(begin_run(Ask::count));
        } else {
            GYROLOG_CHECK(ask(Ask::start_by_command, glp_frame_start));
            note_run(Run::By::command, Ask::start_by_command);
        }
        GYROLOG_CHECK(stream_for(short_run_s, begin_of_run_));
        GYROLOG_CHECK(ask(Ask::stop, glp_frame_stop));
        GYROLOG_CHECK(ask(Ask::status_after_stop, glp_frame_get_status));
        if (dialogue_.has_line) {
            GYROLOG_CHECK(ask(Ask::start_by_command, glp_frame_start));
            note_run(Run::By::command, Ask::start_by_command);
            GYROLOG_CHECK(stream_for(short_run_s / 2, begin_of_run_));
            GYROLOG_CHECK(probe_.set_line_state(false));
        }
        GYROLOG_CHECK(listen_for_nothing());
        return ask(Ask::status_at_end, glp_frame_get_status);
    }

    // The device as it was found; whatever goes wrong here is of no account.
    void restore() {
        if (!original_ || probe_.ended()) { return; }
        const AskedSettings back{
            .rate_mHz = original_->rate_mHz,
            .gyro_full_scale_dps = original_->gyro_full_scale_dps,
            .accel_full_scale_g = original_->accel_full_scale_g,
            .dlpf_hz = original_->dlpf_hz != 0 ? original_->dlpf_hz : std::uint16_t{GLP_DLPF_OFF},
            .layout = original_->layout,
            .samples_per_frame = original_->samples_per_frame};
        static_cast<void>(probe_.write(probe_.command(glp_frame_stop, {})));
        static_cast<void>(probe_.write(probe_.command(glp_frame_configure, payload_of(back))));
        static_cast<void>(probe_.await_reply(probe_.last_number()));
        // The CONFIG behind it is not to be cut off: the next one on this line would find half a frame.
        static_cast<void>(
            probe_.await_silence(probe_.held_up() ? held_up_silence_s : settle_s, settle_limit_s));
        if (dialogue_.has_line) { static_cast<void>(probe_.set_line_state(false)); }
    }

    // ------------------------------------------------------------------------------------------- single
    // steps

    Status go_on() {
        if (const auto error = probe_.lost()) { return *error; }
        if (probe_.ended()) {
            return Error{ErrorCode::device_lost, source_.identity().uri + ": the line was closed"};
        }
        if (!go_on_()) { return Error{ErrorCode::failed, "stopped before the conversation's end"}; }
        return {};
    }

    // Once nothing more can be learnt, what follows is not asked; the rules say so.
    bool pointless() {
        if (dialogue_.broken_off.empty() && probe_.flooded()) {
            dialogue_.broken_off = "the device talks without end";
        } else if (dialogue_.broken_off.empty() && unanswered_ >= unanswered_max) {
            dialogue_.broken_off = std::to_string(unanswered_) + " commands in a row were not answered";
        }
        return !dialogue_.broken_off.empty();
    }

    Exchange& note(Ask ask, unsigned type) {
        auto& exchange = dialogue_.exchanges[static_cast<std::size_t>(ask)];
        exchange = Exchange{};
        exchange->type = type;
        exchange->number = probe_.last_number();
        exchange->sent = probe_.entry_count();
        return *exchange;
    }

    Status ask_raw(Ask ask, const std::vector<Bytes>& writes, unsigned type) {
        GYROLOG_CHECK(go_on());
        if (pointless()) { return {}; }
        note(ask, type);
        for (const Bytes& bytes : writes) { GYROLOG_CHECK(probe_.write(bytes)); }
        const bool answered = probe_.await_reply(probe_.last_number());
        unanswered_ = answered ? 0 : unanswered_ + 1;
        return {};
    }

    Status ask(Ask ask, unsigned type, const Bytes& payload = {}) {
        return ask_raw(ask, {probe_.command(type, payload)}, type);
    }

    // No wait: an answer would come before that to the next command.
    Status ask_unanswered(Ask ask, const Bytes& wire, unsigned type) {
        GYROLOG_CHECK(go_on());
        if (pointless()) { return {}; }
        note(ask, type);
        return probe_.write(wire);
    }

    Status configure(Ask which, const AskedSettings& wanted) {
        GYROLOG_CHECK(ask(which, glp_frame_configure, payload_of(wanted)));
        auto& exchange = dialogue_.exchanges[static_cast<std::size_t>(which)];
        if (exchange) { exchange->configure = wanted; }
        return {};
    }

    Status begin_run(Ask ask_without_line) {
        if (pointless()) { return {}; }
        if (dialogue_.has_line) {
            // What is still on its way would be dropped by the rising DTR.
            GYROLOG_CHECK(listen_for_nothing());
            begin_of_run_ = probe_.entry_count();
            dialogue_.runs.push_back({.by = Run::By::line, .entries = {begin_of_run_, 0}});
            return probe_.set_line_state(true);
        }
        GYROLOG_CHECK(ask(ask_without_line, glp_frame_start));
        note_run(Run::By::command, ask_without_line);
        return {};
    }

    void begin_configured_run() { note_run(Run::By::configure, Ask::configure_streaming); }

    void note_run(Run::By by, Ask ask) {
        const auto& exchange = dialogue_.asked(ask);
        if (!exchange) { return; }
        begin_of_run_ = exchange->sent;
        dialogue_.runs.push_back({.by = by, .entries = {begin_of_run_, 0}, .ask = ask});
    }

    Status end_run() {
        if (pointless()) { return {}; }
        if (!dialogue_.has_line) { return ask(Ask::stop_at_end, glp_frame_stop); }
        const std::size_t begin = probe_.entry_count();
        GYROLOG_CHECK(probe_.set_line_state(false));
        probe_.await(
            [begin](const Transcript& now) {
                return std::any_of(now.entries().begin() + static_cast<std::ptrdiff_t>(begin),
                                   now.entries().end(), [](const TranscriptEntry& entry) {
                                       const auto event = event_in(entry);
                                       return event && event->code == glp_event_stopped;
                                   });
            },
            stopping_s, stopping_s);
        GYROLOG_CHECK(listen_for_nothing());
        dialogue_.lowered = Passage{begin, probe_.entry_count()};
        return {};
    }

    Status stream_for(double device_s, std::size_t from) {
        GYROLOG_CHECK(go_on());
        if (pointless()) { return {}; }
        DeviceTime time(from);
        // Three times as long by the clock: a tick rate that is told wrong is for the rules to judge.
        probe_.await([&](const Transcript& now) { return time.covered_s(now) >= device_s; },
                     probe_.held_up() ? 5.0 : silence_is_end_s, 3.0 * device_s + 1.0);
        return {};
    }

    Status listen_for_nothing() {
        GYROLOG_CHECK(go_on());
        const double silence_s = probe_.held_up() ? held_up_silence_s : listen_s;
        probe_.await([](const Transcript&) { return false; }, silence_s, silence_s);
        return {};
    }

    std::optional<glp_config> latest_config() {
        std::optional<glp_config> config;
        probe_.await(
            [&](const Transcript& now) {
                for (const TranscriptEntry& entry : now.entries()) {
                    if (const auto told = config_in(entry)) { config = told; }
                }
                return true;
            },
            0.0, 0.0);
        return config;
    }

    static void append(Bytes& to, const Bytes& what) { to.insert(to.end(), what.begin(), what.end()); }

    void complete();
    std::size_t first_of_answer(const Exchange& exchange) const;

    ByteSource& source_;
    Probe probe_;
    const std::function<bool()>& go_on_;
    Dialogue dialogue_;
    std::optional<glp_config> original_;
    std::size_t begin_of_run_ = 0;
    unsigned unanswered_ = 0;
};

// The REPLY, or a HELLO before it: what comes earlier is of the run before, or of an earlier command.
std::size_t Conversation::first_of_answer(const Exchange& exchange) const {
    if (!exchange.reply) { return exchange.sent; }
    std::size_t first = exchange.sent;
    while (first < *exchange.reply && !dialogue_.entry(first).is_frame(glp_frame_hello)) { ++first; }
    return exchange.type == glp_frame_start ? first : *exchange.reply;
}

void Conversation::complete() {
    const auto& entries = dialogue_.entries();
    for (auto& exchange : dialogue_.exchanges) {
        if (!exchange) { continue; }
        for (std::size_t i = exchange->sent; i < entries.size(); ++i) {
            const auto reply = reply_in(entries[i]);
            if (!reply || reply->command_sequence != exchange->number) { continue; }
            ++exchange->replies;
            if (exchange->reply) { continue; }
            exchange->reply = i;
            exchange->answer = reply;
        }
        if (!exchange->reply) { continue; }
        exchange->end = *exchange->reply + 1;
        while (exchange->end < entries.size() && !entries[exchange->end].is_frame(glp_frame_reply) &&
               entries[exchange->end].kind != TranscriptEntry::Kind::line) {
            ++exchange->end;
        }
    }
    for (std::size_t i = 0; i < dialogue_.runs.size(); ++i) {
        Run& run = dialogue_.runs[i];
        if (run.ask) { run.entries.begin = first_of_answer(*dialogue_.asked(*run.ask)); }
        if (i > 0) { dialogue_.runs[i - 1].entries.end = run.entries.begin; }
        run.entries.end = entries.size();
    }
    for (Run& run : dialogue_.runs) {
        for (std::size_t i = run.entries.begin; i < run.entries.end && !run.config; ++i) {
            run.config = config_in(entries[i]);
        }
        if (!run.config) { run.config = dialogue_.last_config_before(run.entries.begin); }
    }
}

}  // namespace

Result<Dialogue> converse(ByteSource& source, const std::function<bool()>& go_on) {
    return Conversation(source, go_on).run();
}

std::optional<glp_hello> Dialogue::hello() const {
    std::optional<glp_hello> last;
    for (const TranscriptEntry& entry : entries()) {
        if (const auto hello = hello_in(entry)) { last = hello; }
    }
    return last;
}

std::optional<glp_config> Dialogue::last_config_before(std::size_t entry) const {
    for (std::size_t i = std::min(entry, entries().size()); i-- > 0;) {
        if (const auto config = config_in(entries()[i])) { return config; }
    }
    return std::nullopt;
}

bool Dialogue::answers_commands() const {
    for (const auto& exchange : exchanges) {
        if (exchange && exchange->reply) { return true; }
    }
    return false;
}

double Dialogue::elapsed_s(std::uint64_t from_ticks, std::uint64_t to_ticks) const {
    const auto told = hello();
    if (!told) { return 0.0; }
    const std::uint64_t mask =
        told->tick_bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << told->tick_bits) - 1;
    const std::uint64_t forward = (to_ticks - from_ticks) & mask;
    // The shorter way round.
    return forward <= mask / 2 ? static_cast<double>(forward) / told->tick_hz
                               : -static_cast<double>((from_ticks - to_ticks) & mask) / told->tick_hz;
}

}  // namespace gyrolog
