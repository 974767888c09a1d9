#include "host/decode/stream_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <gyrolog_protocol/usb_identity.h>

namespace gyrolog {

namespace {

// SET_CONTROL_LINE_STATE with DTR, as the host sent it (USB CDC PSTN 1.2, 6.3.12).
bool raises_line(const Transfer& transfer) {
    return transfer.event == Transfer::Event::submission && transfer.kind == TransferKind::control &&
           transfer.setup[0] == 0x21 && transfer.setup[1] == GLP_CDC_SET_CONTROL_LINE_STATE &&
           (transfer.setup[2] & GLP_CDC_LINE_DTR) != 0;
}

// What cannot change within one boot. The sensor may: one that did not answer may answer later.
bool contradicts(const glp_hello& told, const glp_hello& now) {
    return told.boot_id == now.boot_id &&
           (told.tick_hz != now.tick_hz || told.tick_bits != now.tick_bits ||
            told.protocol_major != now.protocol_major ||
            !std::equal(std::begin(told.uid), std::end(told.uid), std::begin(now.uid)));
}

}  // namespace

bool StreamDecoder::take(const Transfer& transfer) {
    if (transfer.carries_stream()) {
        feed(transfer.data, transfer.time);
        return false;
    }
    if (line_raised_ || !raises_line(transfer)) { return false; }
    line_raised_ = true;
    if (before_start_ || connections_ > 1) { return true; }
    before_start_ = counts();
    accounts_ = {};
    joins_ = {};
    restarts_ = {};
    timeline_ = {};
    liveness_ = SampleLiveness();
    builder_ = RecordingBuilder(options_.stream_bytes, options_.samples_per_row, options_.with_accelerometer);
    hello_.reset();
    config_.reset();
    status_.reset();
    run_ = 0;
    return true;
}

void StreamDecoder::begin_connection() {
    frames_.cut();
    accounts_.begin_connection();
    liveness_.begin_clock();
    line_raised_ = false;
    ++connections_;
}

// Nothing numbers the instants between two runs; the grid on which a recording is laid has so many places
// there.
std::uint64_t StreamDecoder::samples_in(const LinkJoin& join, double nominal_hz) const {
    constexpr double longest_s = 1e9;
    constexpr double most_instants = 1e14;  // the same at 100 kHz: a broken clock may give any rate
    const auto estimate = timeline_.rate(join.run_before, join.run_before);
    const double rate_hz = estimate ? estimate->rate_hz : nominal_hz;
    const auto from_s = timeline_.device_time_s(join.run_before, join.end_index, rate_hz);
    const auto to_s = timeline_.device_time_s(join.run_after, join.first_index, rate_hz);
    if (!from_s || !to_s) { return 0; }
    const double pause_s = std::clamp(*to_s - *from_s, 0.0, longest_s);
    return static_cast<std::uint64_t>(std::llround(std::min(pause_s * rate_hz, most_instants)));
}

std::uint64_t StreamDecoder::samples_in(const std::vector<LinkJoin>& joins, const Pauses& pauses,
                                        std::size_t at) const {
    return at < pauses.settled.size() ? pauses.settled[at] : samples_in(joins[at], pauses.nominal_hz[at]);
}

std::uint64_t StreamDecoder::samples_in_all(const std::vector<LinkJoin>& joins, const Pauses& pauses) const {
    std::uint64_t sum = pauses.settled_sum;
    for (std::size_t at = pauses.settled.size(); at < joins.size(); ++at) {
        sum += samples_in(joins, pauses, at);
    }
    return sum;
}

void StreamDecoder::settle(const std::vector<LinkJoin>& joins, Pauses& pauses) const {
    pauses.nominal_hz.resize(joins.size(), config_ ? config_->rate_mHz * 1e-3 : 0.0);
    for (std::size_t at = pauses.settled.size(); at < joins.size() && timeline_.settled(joins[at].run_after);
         ++at) {
        pauses.settled.push_back(samples_in(joins, pauses, at));
        pauses.settled_sum += pauses.settled.back();
    }
}

void StreamDecoder::complete(LinkCounts& counts) const {
    counts.samples_in_joins = samples_in_all(accounts_.joins(), joins_);
    counts.samples_in_stops = samples_in_all(accounts_.restarts(), restarts_);
    counts.samples.missing += counts.samples_in_joins;
    counts.samples_frozen = liveness_.frozen_samples();
    counts.hellos_contradicting = hellos_contradicting_;
    counts.frames.corrupted += hellos_contradicting_;
    counts.frames.corrupted_by_reason[glp_status_bad_value] += hellos_contradicting_;
    if (before_start_) {
        counts.hellos_contradicting -= before_start_->hellos_contradicting;
        counts.frames_before_start = before_start_->frames.good;
        counts.frames.corrupted -= before_start_->frames.corrupted;
        for (std::size_t reason = 0; reason < counts.frames.corrupted_by_reason.size(); ++reason) {
            counts.frames.corrupted_by_reason[reason] -= before_start_->frames.corrupted_by_reason[reason];
        }
    }
}

LinkCounts StreamDecoder::counts() const {
    LinkCounts counts = accounts_.counts(frames_);
    complete(counts);
    return counts;
}

LinkReport StreamDecoder::report() const {
    LinkReport report = accounts_.report(frames_);
    complete(report);
    // Both are in the order of their runs; a join comes behind what is missing in the run before it.
    std::vector<LinkDropout> merged;
    merged.reserve(report.dropouts.size() + report.joins.size());
    auto dropout = report.dropouts.begin();
    for (std::size_t i = 0; i < report.joins.size(); ++i) {
        const LinkJoin& join = report.joins[i];
        while (dropout != report.dropouts.end() && dropout->run <= join.run_before) {
            merged.push_back(*dropout++);
        }
        merged.push_back({join.run_before, join.end_index, samples_in(report.joins, joins_, i), join.cause});
    }
    merged.insert(merged.end(), dropout, report.dropouts.end());
    report.dropouts = std::move(merged);
    for (std::size_t i = 0; i < report.restarts.size(); ++i) {
        const LinkJoin& stop = report.restarts[i];
        report.stops.push_back(
            {stop.run_before, stop.end_index, samples_in(report.restarts, restarts_, i), stop.cause});
    }
    return report;
}

void StreamDecoder::on_hello(const ReceivedFrame& frame, const glp_hello& hello) {
    if (hello_ && contradicts(*hello_, hello)) {
        if (accounts_.take_malformed(frame.frame)) { ++hellos_contradicting_; }
        return;
    }
    if (!accounts_.take_hello(frame.frame, hello)) { return; }
    if (hello_ && hello_->boot_id != hello.boot_id) { liveness_.begin_clock(); }
    hello_ = hello;
    timeline_.take_hello(hello);
    liveness_.take_hello(hello);
    if (options_.observer != nullptr) { options_.observer->on_hello(frame, hello); }
}

void StreamDecoder::on_config(const ReceivedFrame& frame, const glp_config& config) {
    if (!accounts_.take_config(frame.frame, config)) { return; }
    config_ = config;
    builder_.take_config(accounts_.boot(), config);
    if (options_.observer != nullptr) { options_.observer->on_config(frame, config); }
}

void StreamDecoder::on_samples(const ReceivedFrame& frame, const glp_samples& samples) {
    const std::optional<SamplePlace> place =
        accounts_.take_samples(frame.frame, samples, since_samples_s(samples.first_ticks, frame));
    if (!place) { return; }
    run_ = place->run;
    timeline_.take_samples(*place, samples, frame.arrival);
    if (open_joins() > 0) {
        settle(accounts_.joins(), joins_);
        settle(accounts_.restarts(), restarts_);
    }
    liveness_.take_samples(samples, config_ ? config_->rate_mHz * 1e-3 : 0.0);
    if (options_.keep_samples) { builder_.take_samples(*place, samples); }
    if (options_.observer != nullptr) { options_.observer->on_samples(frame, samples); }
}

void StreamDecoder::on_status(const ReceivedFrame& frame, const glp_device_status& status) {
    if (!accounts_.take_status(frame.frame, status, since_samples_s(status.ticks, frame))) { return; }
    status_ = status;
    liveness_.take_status(status);
    note_silence();
    if (options_.observer != nullptr) { options_.observer->on_status(frame, status); }
}

void StreamDecoder::on_event(const ReceivedFrame& frame, const glp_event& event) {
    if (!accounts_.take_event(frame.frame, event, since_samples_s(event.ticks, frame))) { return; }
    liveness_.take_event(event);
    note_silence();
    if (options_.observer != nullptr) { options_.observer->on_event(frame, event); }
}

std::optional<double> StreamDecoder::since_samples_s(std::uint64_t ticks, const ReceivedFrame& frame) const {
    return timeline_.since_last_s(accounts_.boot(), ticks, frame.arrival);
}

void StreamDecoder::note_silence() {
    if (!liveness_.may_be_silent()) { return; }  // else the rate is worked out for nothing
    accounts_.note_silence(liveness_.silent_instants(rate_hz().value_or(0.0)));
}

void StreamDecoder::on_reply(const ReceivedFrame& frame, const glp_reply& reply) {
    if (!accounts_.take_other(frame.frame)) { return; }
    if (options_.observer != nullptr) { options_.observer->on_reply(frame, reply); }
}

void StreamDecoder::on_unknown(const ReceivedFrame& frame) {
    if (!accounts_.take_other(frame.frame)) { return; }
    if (options_.observer != nullptr) { options_.observer->on_unknown(frame); }
}

void StreamDecoder::on_malformed(const ReceivedFrame& frame, glp_status reason) {
    if (!accounts_.take_malformed(frame.frame)) { return; }
    if (options_.observer != nullptr) { options_.observer->on_malformed(frame, reason); }
}

std::optional<double> StreamDecoder::rate_hz() const {
    if (const auto estimate = timeline_.rate(run_, run_)) { return estimate->rate_hz; }
    if (config_ && config_->rate_mHz > 0) { return config_->rate_mHz * 1e-3; }
    return std::nullopt;
}

std::vector<Dropout> StreamDecoder::timed(const std::vector<LinkDropout>& dropouts) const {
    return timeline_.time_dropouts(dropouts, config_ ? config_->rate_mHz * 1e-3 : 0.0);
}

}  // namespace gyrolog
