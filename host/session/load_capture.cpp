#include "host/session/load_capture.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string_view>
#include <utility>

#include "host/base/counted.hpp"
#include "host/capture/segment_files.hpp"

namespace gyrolog {
namespace {

// 0 when it cannot be known.
std::uint64_t size_of(const std::string& path) {
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(path, unknown);
    return unknown ? 0 : size;
}

FileEnd worse(FileEnd a, FileEnd b) { return std::max(a, b); }

void add(CaptureAccounts& sum, const CaptureAccounts& part) {
    sum.blocks.bytes_total += part.blocks.bytes_total;
    sum.blocks.bytes_in_blocks += part.blocks.bytes_in_blocks;
    sum.blocks.bytes_damaged += part.blocks.bytes_damaged;
    sum.blocks.bytes_in_tail += part.blocks.bytes_in_tail;
    sum.blocks.blocks += part.blocks.blocks;
    sum.blocks.damaged_ranges += part.blocks.damaged_ranges;
    sum.blocks.bytes_behind_close += part.blocks.bytes_behind_close;
    sum.blocks.damage.insert(sum.blocks.damage.end(), part.blocks.damage.begin(), part.blocks.damage.end());
    sum.blocks.end = worse(sum.blocks.end, part.blocks.end);
    sum.transfers += part.transfers;
    sum.stream_bytes += part.stream_bytes;
    sum.failed_transfers += part.failed_transfers;
    sum.truncated_transfers += part.truncated_transfers;
    sum.foreign_packets += part.foreign_packets;
}

// Reads files one behind the other into one decoder.
class Loading {
public:
    Loading(LoadedCapture& loaded, const StageObserver& on_stage, std::size_t samples_most,
            std::function<void(std::uint64_t)> on_bytes)
        : loaded_(loaded), on_stage_(on_stage), samples_most_(samples_most), on_bytes_(std::move(on_bytes)) {}

    bool enough() const { return loaded_.decoder->kept_samples() >= samples_most_; }

    Status read(const std::string& path) {
        GYROLOG_TRY(CaptureReader reader, CaptureReader::open(path));
        std::uint64_t stream_bytes = 0;
        std::uint64_t gone = 0;
        const auto hold_against = [&](const std::optional<CaptureCheckpoint>& checkpoint) {
            if (!checkpoint) { return; }
            if (checkpoint->stream_bytes > stream_bytes) {
                gone = std::max(gone, checkpoint->stream_bytes - stream_bytes);
            }
            hold_counters(*checkpoint, stream_bytes);
        };
        follow(reader.segment());
        while (!enough()) {
            on_stage_("read");
            GYROLOG_TRY(const std::optional<CapturedTransfer> captured, reader.next());
            hold_against(reader.checkpoint());
            if (!captured) { break; }
            follow(reader.segment());
            if (captured->transfer.carries_stream()) { stream_bytes += captured->transfer.data.size(); }
            on_bytes_(captured->transfer.data.size());
            on_stage_("decode");
            meet_connection(reader.segment());
            take(captured->transfer);
        }
        add(loaded_.file, reader.accounts());
        loaded_.stream_bytes_gone += gone;
        if (!loaded_.metadata) { loaded_.metadata = reader.metadata(); }
        loaded_.last_checkpoint = reader.checkpoint();
        loaded_.marks.insert(loaded_.marks.end(), reader.marks().begin(), reader.marks().end());
        return {};
    }

private:
    // What does not say that it goes on with the stream before does not.
    void meet_connection(const std::optional<CaptureSegment>& segment) {
        if (!segment) { return; }
        const bool goes_on = !present_ || (present_->capture == segment->capture &&
                                           present_->connection == segment->connection);
        if (!goes_on) { loaded_.decoder->begin_connection(); }
        present_ = segment;
    }

    // Whether all files of the capture have been read so far: the counters are of all of them.
    void follow(const std::optional<CaptureSegment>& segment) {
        if (!segment || segment->number == part_) { return; }
        is_without_gap_ = is_without_gap_ && segment->number == part_ + 1;
        part_ = segment->number;
    }

    // The writer decodes what it writes: up to a checkpoint it counts what is decoded here. Those with which
    // a file is closed where another one follows are of the checkpoint before.
    void hold_counters(const CaptureCheckpoint& checkpoint, std::uint64_t stream_bytes) {
        if (!is_without_gap_ || checkpoint.counters == held_) { return; }
        held_ = checkpoint.counters;
        if (checkpoint.stream_bytes > stream_bytes) { return; }
        const LinkCounts link = loaded_.decoder->counts();
        const auto compare = [&](std::uint64_t told, std::uint64_t found, const char* what) {
            if (told == found || !contradicted_.insert(what).second) { return; }
            loaded_.contradictions_of_writer.push_back("the writer counted " + counted(told, what) +
                                                       " up to a checkpoint, and " + format_count(found) +
                                                       (found == 1 ? " is there" : " are there"));
        };
        compare(checkpoint.stream_bytes, stream_bytes, "byte");
        compare(held_.frames, link.frames.good, "frame");
        compare(held_.samples, link.samples.good, "sample");
    }

    void take(const Transfer& transfer) {
        if (!any_data_ && transfer.carries_stream() && !transfer.data.empty()) {
            loaded_.first_data = transfer.time;
            any_data_ = true;
        }
        static_cast<void>(loaded_.decoder->take(transfer));
    }

    LoadedCapture& loaded_;
    const StageObserver& on_stage_;
    std::size_t samples_most_;
    std::function<void(std::uint64_t)> on_bytes_;  // of each transfer
    bool any_data_ = false;
    std::optional<CaptureSegment> present_;
    std::uint64_t part_ = 0;
    bool is_without_gap_ = true;
    CaptureCounters held_;
    std::set<std::string_view> contradicted_;
};

}  // namespace

std::vector<std::string> LoadedCapture::contradictions() const {
    std::vector<std::string> all = sentences(decoder->counts().contradictions);
    all.insert(all.end(), contradictions_of_writer.begin(), contradictions_of_writer.end());
    return all;
}

Result<LoadedCapture> load_capture(const std::string& path, bool keep_samples, const StageObserver& on_stage,
                                   const KeptRows& kept, const ShareObserver& on_share) {
    LoadedCapture loaded;
    loaded.files = segment_files(path);
    std::uint64_t stream_bytes = 0;
    for (const std::string& file : loaded.files) { stream_bytes += size_of(file); }
    loaded.decoder =
        std::make_unique<StreamDecoder>(StreamDecoderOptions{.keep_samples = keep_samples,
                                                             .observer = nullptr,
                                                             .stream_bytes = stream_bytes,
                                                             .samples_per_row = kept.samples_per_row,
                                                             .with_accelerometer = kept.with_accelerometer});
    std::uint64_t bytes_read = 0;
    Loading loading(loaded, on_stage, kept.samples_most, [&](std::uint64_t bytes) {
        bytes_read += bytes;
        if (on_share && stream_bytes > 0) {
            on_share(static_cast<double>(bytes_read) / static_cast<double>(stream_bytes));
        }
    });
    for (const std::string& file : loaded.files) {
        GYROLOG_CHECK(loading.read(file));
        if (loading.enough()) { break; }
    }
    if (loaded.file.blocks.bytes_total == 0) {
        return Error{ErrorCode::malformed, "read capture '" + path + "': the file is empty"};
    }
    if (loaded.file.blocks.blocks == 0) {
        return Error{ErrorCode::malformed,
                     "read capture '" + path +
                         "': it holds no whole block: it is no capture, or its writer died before it had "
                         "written one"};
    }
    const bool is_whole = loaded.file.blocks.damaged_ranges == 0 && loaded.stream_bytes_gone == 0 &&
                          loaded.file.truncated_transfers == 0;
    if (!is_whole) { loaded.contradictions_of_writer.clear(); }
    return loaded;
}

bool looks_like_capture(const std::string& path) {
    if (path.ends_with(".pcapng") || path.ends_with(".pcap")) { return true; }
    // What is read from a pipe is gone for whoever reads it next.
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(path, unknown)) { return false; }
    constexpr std::array<std::string_view, 3> beginnings{"\x0A\x0D\x0D\x0A", "\xD4\xC3\xB2\xA1",
                                                         "\x4D\x3C\xB2\xA1"};
    std::array<char, 4> begin{};
    std::ifstream file(path, std::ios::binary);
    return file.read(begin.data(), begin.size()) &&
           std::ranges::find(beginnings, std::string_view(begin.data(), begin.size())) != beginnings.end();
}

}  // namespace gyrolog
