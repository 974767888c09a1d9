// A device's byte stream, decoded: accounts of what arrived, times, and if wanted the samples. Live, replayed
// and stored data go through here alike.
//
//     StreamDecoder decoder({.keep_samples = true});
//     for (...) { decoder.take(transfer); }
//     GYROLOG_TRY(Recording recording, decoder.take_recording("night"));
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "host/base/bytes.hpp"
#include "host/base/clock.hpp"
#include "host/base/result.hpp"
#include "host/decode/frame_decoder.hpp"
#include "host/decode/link_accounts.hpp"
#include "host/decode/recording_builder.hpp"
#include "host/decode/sample_liveness.hpp"
#include "host/decode/sample_timeline.hpp"
#include "host/transport/transfer.hpp"

namespace gyrolog {

struct StreamDecoderOptions {
    bool keep_samples = false;           // without it, memory does not grow with the stream
    MessageHandler* observer = nullptr;  // gets every message but the duplicates; may be null
    std::uint64_t stream_bytes = 0;      // expected, for making room; 0: not known
    std::size_t samples_per_row = 1;     // of what is kept, more: their means (RecordingBuilder)
    bool with_accelerometer = true;      // of what is kept
};

class StreamDecoder : private MessageHandler {
public:
    explicit StreamDecoder(StreamDecoderOptions options = {})
        : options_(options),
          builder_(options.stream_bytes, options.samples_per_row, options.with_accelerometer) {}

    // Feeds what a transfer carries of the stream. The transfer by which the host first raises DTR begins the
    // accounts anew: what a board still had from an earlier listener is in the bytes, but its gaps are not
    // this stream's. True for that transfer, and for the first such one of each later connection.
    bool take(const Transfer& transfer);
    // What comes next comes over another connection: the board was unplugged, or given up for lost.
    void begin_connection();
    void feed(ByteView bytes, HostTime arrival) { frames_.feed(bytes, arrival, *this); }

    LinkReport report() const;
    // The report's numbers, at a cost that does not grow with the stream.
    LinkCounts counts() const;
    // Joins that counts() works out anew: a few, however many there were.
    std::size_t open_joins() const {
        return accounts_.joins().size() - joins_.settled.size() + accounts_.restarts().size() -
               restarts_.settled.size();
    }
    const SampleTimeline& timeline() const { return timeline_; }
    // As last told by the board, over whatever connection.
    const std::optional<glp_hello>& hello() const { return hello_; }
    // Of the last samples, as the timeline numbers runs.
    std::uint32_t run() const { return run_; }
    std::uint64_t intact_frames() const { return frames_.intact_frames(); }
    const std::optional<glp_config>& config() const { return config_; }
    const std::optional<glp_device_status>& device_status() const { return status_; }
    const SampleLiveness& liveness() const { return liveness_; }
    // The sensor's rate in the present run: by the stamps, or nominal before there are enough of them.
    std::optional<double> rate_hz() const;
    // With its uncertainty; no value before there are enough stamps.
    std::optional<RateEstimate> rate_estimate() const { return timeline_.rate(run_, run_); }
    // The report's dropouts, or its stops, with their time from the first sample.
    std::vector<Dropout> timed(const std::vector<LinkDropout>& dropouts) const;

    std::size_t kept_samples() const { return builder_.samples(); }
    // Only with keep_samples. Empties the store of samples.
    Result<Recording> take_recording(std::string name) {
        return builder_.finish(std::move(name), timeline_, report());
    }
    // Of the recording that was taken: sampling instant 0 by the host's clock.
    std::optional<double> recording_host_start_s() const { return builder_.host_start_s(); }

private:
    // How many instants passed in each of a list of joins. Each is worked out once: a board may be reset, or
    // pretend to be, any number of times.
    struct Pauses {
        std::vector<double> nominal_hz;      // as configured when the join was found
        std::vector<std::uint64_t> settled;  // of the first joins, of which no more is learned
        std::uint64_t settled_sum = 0;
    };

    void on_hello(const ReceivedFrame& frame, const glp_hello& hello) override;
    void on_config(const ReceivedFrame& frame, const glp_config& config) override;
    void on_samples(const ReceivedFrame& frame, const glp_samples& samples) override;
    void on_status(const ReceivedFrame& frame, const glp_device_status& status) override;
    void on_event(const ReceivedFrame& frame, const glp_event& event) override;
    void on_reply(const ReceivedFrame& frame, const glp_reply& reply) override;
    void on_unknown(const ReceivedFrame& frame) override;
    void on_malformed(const ReceivedFrame& frame, glp_status reason) override;
    std::uint64_t samples_in(const LinkJoin& join, double nominal_hz) const;
    std::uint64_t samples_in(const std::vector<LinkJoin>& joins, const Pauses& pauses, std::size_t at) const;
    std::uint64_t samples_in_all(const std::vector<LinkJoin>& joins, const Pauses& pauses) const;
    void settle(const std::vector<LinkJoin>& joins, Pauses& pauses) const;
    void complete(LinkCounts& counts) const;
    std::optional<double> since_samples_s(std::uint64_t ticks, const ReceivedFrame& frame) const;
    void note_silence();

    StreamDecoderOptions options_;
    FrameDecoder frames_;
    LinkAccounts accounts_;
    SampleTimeline timeline_;
    SampleLiveness liveness_;
    RecordingBuilder builder_;
    std::optional<glp_hello> hello_;
    std::optional<glp_config> config_;
    std::optional<glp_device_status> status_;
    std::uint32_t run_ = 0;
    std::uint64_t hellos_contradicting_ = 0;
    std::optional<LinkCounts> before_start_;
    Pauses joins_;
    Pauses restarts_;
    unsigned connections_ = 1;
    bool line_raised_ = false;  // in the present connection
};

}  // namespace gyrolog
