// Finds the intact blocks of a capture file, whatever has happened to the rest of it.
//
// Invariants:
//   - size_bytes() == bytes_in_blocks + bytes damaged + bytes_in_tail once next() has returned nothing. No
//     byte is ever unaccounted for.
//   - A broken block costs itself: the next block is found by its own lengths and checksum, not by the broken
//     one's.
//   - Memory does not grow with the file, and work only in proportion: of candidates that prove broken, no
//     more than bytes_judged_in_vain_max() is looked at, and of a section's interfaces no more than
//     interfaces_max are known. Where a made-up file asks for more, a candidate counts as broken unseen.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"
#include "host/capture/input_file.hpp"
#include "host/capture/pcapng.hpp"

namespace gyrolog {

enum class BlockKind {
    section,  // a section header; of a classic pcap file, the file's header
    interface_description,
    packet,
    statistics,
    other,  // a block of a foreign file that means nothing here
};

struct CaptureBlock {
    BlockKind kind = BlockKind::other;
    std::uint64_t offset = 0;
    ByteView bytes;  // as in the file; valid until the next call of next()
    // Of a packet:
    std::int64_t time_ns = 0;  // since the Unix epoch
    ByteView packet;
    std::uint32_t original_bytes = 0;
    std::uint32_t link_type = 0;
    bool vouched = false;  // by a checksum of its own
};

struct DamagedRange {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
};

enum class FileEnd {
    clean,      // the last block ends where the file ends
    torn_tail,  // the file ends inside the block that was being written, in zeros, or both: the writer died
    damaged,    // anything else that is no intact block: the medium or an editor did that
};

struct BlockAccounts {
    std::uint64_t bytes_total = 0;
    std::uint64_t bytes_in_blocks = 0;
    std::uint64_t bytes_damaged = 0;  // with intact blocks behind them
    std::uint64_t bytes_in_tail = 0;  // with nothing intact behind them, torn or damaged
    std::uint64_t blocks = 0;
    std::uint64_t damaged_ranges = 0;
    std::uint64_t bytes_behind_close = 0;  // of the tail, where the writer had closed the file before it
    std::vector<DamagedRange> damage;      // the first of them, up to a thousand
    FileEnd end = FileEnd::clean;
    std::uint64_t bytes_judged_in_vain = 0;  // of candidates that looked like blocks and were none

    // Nothing of the capture is damaged: its end is known, and something else stands behind it.
    bool only_behind_close() const {
        return bytes_behind_close > 0 && bytes_behind_close == bytes_damaged + bytes_in_tail;
    }
    bool balanced() const { return bytes_total == bytes_in_blocks + bytes_damaged + bytes_in_tail; }
};

// Up to this offset of a file. A broken block is judged once, so that honest damage costs its own length;
// eight times that leaves room for captures within captures.
constexpr std::uint64_t bytes_judged_in_vain_max(std::uint64_t offset) {
    return 8 * (offset + pcapng::block_bytes_max);
}

class BlockScanner {
public:
    // Of a section: as many as the 16 bits of a pcapng Packet Block can name.
    static constexpr std::size_t interfaces_max = std::size_t{1} << 16U;

    explicit BlockScanner(std::unique_ptr<InputFile> file);

    // The next intact block, or nothing at the end. Error: the file could not be read; or, from the first
    // call, `malformed`: it does not begin like a capture and holds no intact block, `unsupported`:
    // big-endian.
    Result<std::optional<CaptureBlock>> next();

    // Begins again at the start of the file.
    void rewind();

    // Complete once next() has returned nothing.
    const BlockAccounts& accounts() const { return accounts_; }
    // Whether the present section was written by this program, whose blocks all carry checksums.
    bool in_own_section() const { return own_section_; }

private:
    enum class Format { pcapng, pcap };
    struct Interface {
        std::uint32_t link_type = 0;
        std::uint64_t ticks_per_s = 1'000'000;
    };

    Status recognise();
    Result<ByteView> view(std::uint64_t offset, std::size_t bytes);
    Result<std::optional<CaptureBlock>> block_at(std::uint64_t offset, bool searching);
    std::optional<CaptureBlock> judge_within_limit(ByteView bytes, std::uint64_t offset, bool searching);
    std::optional<CaptureBlock> judge(ByteView bytes, bool searching) const;
    std::optional<CaptureBlock> judge_packet(ByteView block, bool searching) const;
    bool must_vouch(bool searching) const;
    std::optional<CaptureBlock> judge_pcap_record(ByteView bytes) const;
    Result<std::optional<std::uint64_t>> find_intact(std::uint64_t from);
    Result<std::uint64_t> end_of_broken(std::uint64_t offset);
    Result<std::uint64_t> end_of_data(std::uint64_t from);
    Result<bool> is_torn(std::uint64_t offset);
    bool may_begin_block(ByteView bytes) const;
    bool closes_capture(const CaptureBlock& block) const;
    void enter_tail(bool torn);
    void enter(const CaptureBlock& block);
    void enter_damage(std::uint64_t offset, std::uint64_t bytes);

    std::unique_ptr<InputFile> file_;
    Format format_ = Format::pcapng;
    bool recognised_ = false;
    bool own_section_ = true;    // until a section header says otherwise, every block must vouch for itself
    bool vouched_seen_ = false;  // in the present section
    bool closed_ = false;        // the block read last is the one with which the writer closes a file
    std::vector<Interface> interfaces_;
    std::uint64_t offset_ = 0;
    Bytes window_;
    std::uint64_t window_offset_ = 0;
    std::size_t window_bytes_ = 0;
    BlockAccounts accounts_;
};

}  // namespace gyrolog
