// One capture from start to finish: source -> queue -> writer, with the handshake before and the accounts
// after. A board that is lost is waited for, if that is wanted, and the capture goes on in another file.
//
// Threads: the source's own (pushes transfers, never waits for the disk), the writer's (appends, decodes for
// the accounts, syncs), the caller's (handshake, progress, stop).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/base/result.hpp"
#include "host/capture/append_file.hpp"
#include "host/decode/protocol.hpp"
#include "host/decode/stream_decoder.hpp"
#include "host/session/capture_control.hpp"
#include "host/transport/byte_source.hpp"

namespace gyrolog {

enum class OnUnplug { end, wait };
// Sees the samples as they come, on the writer's thread, which it must not keep waiting.
class SampleObserver {
public:
    virtual ~SampleObserver() = default;
    // What came before was meant for an earlier listener.
    virtual void on_start() = 0;
    // Once their configuration is known.
    virtual void on_samples(const glp_frame& frame, const glp_samples& samples, const glp_config& config) = 0;
    // Before any of these: what decodes the stream. Within on_samples() it may be asked where these samples
    // stand in time; at no other time.
    virtual void on_decoder(const StreamDecoder& /*decoder*/) {}
};

struct CaptureRequest {
    std::string path;
    bool overwrite = false;
    std::optional<double> duration_s;      // of device time
    std::optional<std::uint64_t> samples;  // at least so many sampling instants
    glp_configure configure{};             // zeros: the board keeps its configuration
    double hello_timeout_s = 3.0;
    double idle_timeout_s = 10.0;  // silence that counts as a lost device
    double silence_s = 2.0;        // without a sample, until the duration is measured by the clock
    std::size_t queue_bytes = std::size_t{16} << 20U;
    CaptureControl* control = nullptr;   // may be null; so may the observer
    SampleObserver* observer = nullptr;  // both must outlive the capture

    OnUnplug on_unplug = OnUnplug::end;
    double reconnect_interval_s = 0.25;         // between two looks for a board that was lost
    std::optional<std::uint64_t> rotate_bytes;  // as in SegmentPlan
    std::optional<double> rotate_s;
    std::uint64_t min_free_bytes = 0;
    Disk* disk = nullptr;  // null: the computer's

    bool has_limit() const { return duration_s.has_value() || samples.has_value(); }
};

struct CaptureProgress {
    bool parked = false;     // the board is away, and waited for
    double parked_s = 0.0;   // for how long
    std::string parked_why;  // what became of the board, or of the last try to go on with it
    unsigned connections = 1;
    // How long this program may stand still without losing anything; infinity where the source waits.
    double tolerated_stall_s = 0.0;
    std::string path;        // of the present file
    double elapsed_s = 0.0;  // of host time since the stream began
    double device_s = 0.0;   // of device time
    std::optional<double> rate_hz;
    std::optional<double> temperature_C;
    std::uint64_t samples = 0;
    std::uint64_t samples_missing = 0;
    std::uint64_t dropouts = 0;
    std::uint64_t frames_corrupted = 0;
    std::uint64_t file_bytes = 0;
    std::uint64_t marks = 0;
    bool streaming = true;  // false while the user has stopped the board
    double silent_s = 0.0;  // since the last sample, while the board streams and the link is alive or not
    double frozen_s = 0.0;  // how long one reading has come again and again; 0 while that may be chance
    std::optional<glp_hello> hello;
    std::optional<glp_config> config;
};

enum class CaptureEnd {
    complete,     // the duration or number of samples asked for, or the source had no more
    interrupted,  // the caller stopped it
    device_lost,  // and not waited for, or not back in time
    storage_failed,
};

struct CaptureOutcome {
    CaptureEnd end = CaptureEnd::complete;
    std::optional<Error> error;  // with device_lost and storage_failed
    CaptureProgress progress;
    LinkReport link;
    std::vector<std::string> paths;  // of the files, in order
    bool kept_old = false;           // no sample came: the file that was to be replaced is as it was
    // Transfers that found the queue full, and their bytes: lost on the host.
    std::uint64_t transfers_dropped = 0;
    std::uint64_t bytes_dropped = 0;
    std::size_t queue_high_water_bytes = 0;

    bool data_lost() const { return !link.complete() || transfers_dropped > 0 || link.samples.good == 0; }
};

// Called some ten times a second on the caller's thread, also while the board has not yet answered (there is
// no hello then); false ends the capture.
using CaptureObserver = std::function<bool(const CaptureProgress&)>;

// Errors are those before the stream began: the file could not be made, the source not started, no HELLO
// came, the board refused the configuration, the caller ended it. The file is then removed, unless bytes of
// the stream are in it and the board refused nothing. A file that is to be replaced is, when the first
// samples are there. Once the stream has begun, whatever ends it, the file is closed and readable and the
// outcome says what happened.
//
// A board that is lost: its file is closed, the source's reconnect() is tried, and with a board that is back
// the handshake begins again, with the configuration that the board last told. The pause counts towards the
// duration and the samples that were asked for.
Result<CaptureOutcome> run_capture(ByteSource& source, const CaptureRequest& request,
                                   const CaptureObserver& observe);

}  // namespace gyrolog
