#include "host/capture/block_scanner.hpp"

#include <algorithm>
#include <string_view>

#include "host/capture/byte_order.hpp"
#include "host/capture/capture_metadata.hpp"
#include "host/capture/pcapng.hpp"
#include "host/capture/usbmon_record.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t window_bytes_max = 4 * pcapng::block_bytes_max;
constexpr std::size_t damage_kept = 1000;
constexpr std::int64_t captured_ns_per_s = 1'000'000'000;

constexpr std::uint32_t swapped_byte_order_magic = 0x4D3C2B1A;
constexpr std::size_t pcap_header_bytes = 24;
constexpr std::size_t pcap_record_header_bytes = 16;
constexpr std::uint32_t pcap_magic_us = 0xA1B2C3D4;
constexpr std::uint32_t pcap_magic_ns = 0xA1B23C4D;
constexpr std::uint32_t pcap_magic_us_swapped = 0xD4C3B2A1;
constexpr std::uint32_t pcap_magic_ns_swapped = 0x4D3CB2A1;

// What only this program writes into a section header. Two, so that no single flipped bit disowns a file.
constexpr std::string_view own_schema = "\"gyrolog-capture/";
constexpr std::string_view own_checksum = "gyrolog-crc32:";

bool plausible_length(std::uint32_t length) {
    return length >= pcapng::block_bytes_min && length % 4 == 0 && length <= pcapng::block_bytes_max;
}

bool is_own(ByteView section_header) {
    const std::string_view text = as_text(section_header);
    return text.find(own_schema) != std::string_view::npos ||
           text.find(own_checksum) != std::string_view::npos;
}

std::uint64_t ticks_per_second(std::uint8_t resolution) {
    const bool power_of_two = (resolution & 0x80U) != 0;
    const unsigned exponent = std::min<unsigned>(resolution & 0x7FU, power_of_two ? 60U : 18U);
    std::uint64_t ticks = 1;
    for (unsigned i = 0; i < exponent; ++i) { ticks *= power_of_two ? 2U : 10U; }
    return ticks;
}

std::int64_t to_ns(std::uint64_t time, std::uint64_t ticks_per_s) {
    const std::uint64_t seconds = std::min<std::uint64_t>(time / ticks_per_s, 9'000'000'000U);
    const std::uint64_t part = time % ticks_per_s;
    const std::uint64_t part_ns =
        captured_ns_per_s % ticks_per_s == 0
            ? part * (captured_ns_per_s / ticks_per_s)
            : static_cast<std::uint64_t>(static_cast<double>(part) * 1e9 / static_cast<double>(ticks_per_s));
    return static_cast<std::int64_t>(seconds * captured_ns_per_s + part_ns);
}

}  // namespace

BlockScanner::BlockScanner(std::unique_ptr<InputFile> file) : file_(std::move(file)) { rewind(); }

void BlockScanner::rewind() {
    accounts_ = BlockAccounts{};
    accounts_.bytes_total = file_->size_bytes();
    offset_ = 0;
    own_section_ = format_ == Format::pcapng;
    vouched_seen_ = false;
    closed_ = false;
    interfaces_.clear();
}

Result<std::optional<CaptureBlock>> BlockScanner::next() {
    if (!recognised_) { GYROLOG_CHECK(recognise()); }
    while (offset_ < accounts_.bytes_total) {
        GYROLOG_TRY(std::optional<CaptureBlock> block, block_at(offset_, false));
        if (block) {
            enter(*block);
            return block;
        }
        GYROLOG_TRY(const std::uint64_t from, end_of_broken(offset_));
        GYROLOG_TRY(const std::optional<std::uint64_t> intact, find_intact(from));
        if (!intact) {
            GYROLOG_TRY(const bool torn, is_torn(offset_));
            enter_tail(torn);
            break;
        }
        enter_damage(offset_, *intact - offset_);
        offset_ = *intact;
    }
    const bool torn = accounts_.bytes_in_tail > 0 || accounts_.blocks == 0;
    accounts_.end = accounts_.damaged_ranges > 0 ? FileEnd::damaged
                    : torn                       ? FileEnd::torn_tail
                                                 : FileEnd::clean;
    return std::optional<CaptureBlock>();
}

// A file that is shorter than its first number may still be the beginning of a capture.
Status BlockScanner::recognise() {
    GYROLOG_TRY(const ByteView begin, view(0, pcapng::block_bytes_min));
    Bytes section;
    put<std::uint32_t>(section, pcapng::section_header);
    section.resize(std::min<std::size_t>(begin.size(), section.size()));
    const bool begins_section = std::equal(section.begin(), section.end(), begin.begin());
    if (begin.size() >= 12 && begins_section && get<std::uint32_t>(begin, 8) == swapped_byte_order_magic) {
        return Error{ErrorCode::unsupported, "a big-endian capture; re-write it on a little-endian machine"};
    }
    const std::uint32_t magic = begin.size() >= 4 ? get<std::uint32_t>(begin, 0) : 0;
    if (magic == pcap_magic_us_swapped || magic == pcap_magic_ns_swapped) {
        return Error{ErrorCode::unsupported, "a big-endian capture; re-write it on a little-endian machine"};
    }
    if (magic == pcap_magic_us || magic == pcap_magic_ns) {
        format_ = Format::pcap;
        own_section_ = false;
    } else if (!begins_section) {
        GYROLOG_TRY(const auto intact, find_intact(0));
        if (!intact) { return Error{ErrorCode::malformed, "not a capture: neither pcapng nor pcap"}; }
        accounts_.bytes_judged_in_vain = 0;  // the first call searches there again
    }
    recognised_ = true;
    return {};
}

Result<ByteView> BlockScanner::view(std::uint64_t offset, std::size_t bytes) {
    const std::uint64_t left = accounts_.bytes_total - std::min(offset, accounts_.bytes_total);
    const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, left));
    if (offset < window_offset_ || offset + wanted > window_offset_ + window_bytes_) {
        window_.resize(
            static_cast<std::size_t>(std::min<std::uint64_t>(window_bytes_max, accounts_.bytes_total)));
        GYROLOG_TRY(window_bytes_, file_->read_at(offset, window_));
        window_offset_ = offset;
    }
    const std::size_t begin = static_cast<std::size_t>(offset - window_offset_);
    return ByteView(window_).subspan(begin, std::min(wanted, window_bytes_ - begin));
}

Result<std::optional<CaptureBlock>> BlockScanner::block_at(std::uint64_t offset, bool searching) {
    std::optional<CaptureBlock> block;
    GYROLOG_TRY(const ByteView begin, view(offset, pcap_header_bytes));
    if (format_ == Format::pcap && offset == 0) {
        if (begin.size() == pcap_header_bytes) {
            block.emplace();
            block->kind = BlockKind::section;
            block->bytes = begin;
        }
        return block;
    }
    std::uint64_t length = 0;
    if (format_ == Format::pcap) {
        if (begin.size() < pcap_record_header_bytes) { return block; }
        length = pcap_record_header_bytes + std::uint64_t{get<std::uint32_t>(begin, 8)};
        if (length > pcapng::block_bytes_max) { return block; }
    } else {
        if (begin.size() < pcapng::block_bytes_min) { return block; }
        length = get<std::uint32_t>(begin, 4);
        if (!plausible_length(static_cast<std::uint32_t>(length))) { return block; }
    }
    GYROLOG_TRY(const ByteView bytes, view(offset, static_cast<std::size_t>(length)));
    if (bytes.size() < length) { return block; }
    block = format_ == Format::pcap ? judge_pcap_record(bytes) : judge_within_limit(bytes, offset, searching);
    if (block) { block->offset = offset; }
    return block;
}

// Candidates may overlap, and each would have its checksum worked out: what is no block is paid for by the
// bytes that are behind it.
std::optional<CaptureBlock> BlockScanner::judge_within_limit(ByteView bytes, std::uint64_t offset,
                                                             bool searching) {
    if (get<std::uint32_t>(bytes, bytes.size() - 4) != bytes.size() ||
        accounts_.bytes_judged_in_vain + bytes.size() > bytes_judged_in_vain_max(offset)) {
        return std::nullopt;
    }
    std::optional<CaptureBlock> block = judge(bytes, searching);
    if (!block) { accounts_.bytes_judged_in_vain += bytes.size(); }
    return block;
}

std::optional<CaptureBlock> BlockScanner::judge(ByteView bytes, bool searching) const {
    CaptureBlock block;
    block.bytes = bytes;
    switch (get<std::uint32_t>(bytes, 0)) {
        case pcapng::section_header:
            if (bytes.size() < 28 || get<std::uint32_t>(bytes, 8) != pcapng::byte_order_magic ||
                get<std::uint16_t>(bytes, 12) != 1 || (is_own(bytes) && !pcapng::section_comment(bytes))) {
                return std::nullopt;
            }
            block.kind = BlockKind::section;
            return block;
        case pcapng::interface_description:
            if (bytes.size() < 20) { return std::nullopt; }
            block.kind = BlockKind::interface_description;
            return block;
        case pcapng::interface_statistics:
            if (bytes.size() < 24 || (must_vouch(searching) && !pcapng::statistics_comment(bytes))) {
                return std::nullopt;
            }
            block.kind = BlockKind::statistics;
            return block;
        case pcapng::enhanced_packet:
            return judge_packet(bytes, searching);
        default:
            break;
    }
    // Any other kind is a foreign program's business; in an own section it is a packet whose type was
    // damaged.
    if (own_section_ || searching) { return std::nullopt; }
    return block;
}

// Editors keep an own section's header but drop its packets' hashes: the first packet shows whether there are
// any.
bool BlockScanner::must_vouch(bool searching) const { return own_section_ && (searching || vouched_seen_); }

// What the packet's hash does not cover is checked against what it does: the time stamp stands in the record,
// too.
std::optional<CaptureBlock> BlockScanner::judge_packet(ByteView bytes, bool searching) const {
    const std::optional<pcapng::Packet> packet = pcapng::read_packet(bytes);
    if (!packet || packet->hash == pcapng::Packet::Hash::wrong) { return std::nullopt; }
    CaptureBlock block;
    block.kind = BlockKind::packet;
    block.bytes = bytes;
    block.packet = packet->bytes;
    block.original_bytes = packet->original_bytes;
    if (own_section_) {
        const auto record = read_usbmon_record(packet->bytes);
        block.link_type = link_type_usb_linux_mmapped;
        block.time_ns = to_ns(packet->time, captured_ns_per_s);
        const bool agrees = record && packet->interface == 0 &&
                            packet->original_bytes == packet->bytes.size() &&
                            block.time_ns / 1000 == record->time_us;
        block.vouched = packet->hash == pcapng::Packet::Hash::right;
        if (!agrees || (must_vouch(searching) && !block.vouched)) { return std::nullopt; }
        return block;
    }
    if (packet->interface >= interfaces_.size()) { return std::nullopt; }
    const Interface& interface = interfaces_[packet->interface];
    block.link_type = interface.link_type;
    block.time_ns = to_ns(packet->time, interface.ticks_per_s);
    if (interface.link_type == link_type_usb_linux_mmapped && !read_usbmon_record(packet->bytes)) {
        return std::nullopt;
    }
    return block;
}

std::optional<CaptureBlock> BlockScanner::judge_pcap_record(ByteView bytes) const {
    if (interfaces_.empty()) { return std::nullopt; }
    const Interface& interface = interfaces_.front();
    const auto part = get<std::uint32_t>(bytes, 4);
    CaptureBlock block;
    block.kind = BlockKind::packet;
    block.bytes = bytes;
    block.packet = bytes.subspan(pcap_record_header_bytes);
    block.original_bytes = get<std::uint32_t>(bytes, 12);
    block.link_type = interface.link_type;
    block.time_ns =
        std::int64_t{get<std::uint32_t>(bytes, 0)} * captured_ns_per_s + to_ns(part, interface.ticks_per_s);
    const bool usb = interface.link_type == link_type_usb_linux_mmapped;
    if (part >= interface.ticks_per_s || block.original_bytes < block.packet.size() ||
        (usb && !read_usbmon_record(block.packet))) {
        return std::nullopt;
    }
    return block;
}

// A block whose two lengths agree is damaged inside: what follows it stands where it should.
Result<std::uint64_t> BlockScanner::end_of_broken(std::uint64_t offset) {
    if (format_ == Format::pcap) { return offset + 1; }
    GYROLOG_TRY(const ByteView begin, view(offset, pcapng::block_bytes_min));
    if (begin.size() < pcapng::block_bytes_min) { return offset + 1; }
    const auto length = get<std::uint32_t>(begin, 4);
    if (!plausible_length(length)) { return offset + 1; }
    GYROLOG_TRY(const ByteView bytes, view(offset, length));
    const bool agrees = bytes.size() == length && get<std::uint32_t>(bytes, length - 4) == length;
    return agrees ? offset + length : offset + 1;
}

bool BlockScanner::may_begin_block(ByteView bytes) const {
    if (format_ == Format::pcap) {
        const auto size = get<std::uint32_t>(bytes, 8);
        return size >= usbmon_header_bytes && size <= pcapng::packet_bytes_max;
    }
    const auto type = get<std::uint32_t>(bytes, 0);
    return (type == pcapng::enhanced_packet || type == pcapng::interface_statistics ||
            type == pcapng::section_header || type == pcapng::interface_description) &&
           plausible_length(get<std::uint32_t>(bytes, 4));
}

Result<std::optional<std::uint64_t>> BlockScanner::find_intact(std::uint64_t from) {
    constexpr std::size_t needed = 12;
    for (std::uint64_t at = from; at + needed <= accounts_.bytes_total;) {
        GYROLOG_TRY(const ByteView bytes, view(at, pcapng::block_bytes_max));
        if (bytes.size() < needed) { break; }
        std::size_t i = 0;
        while (i + needed <= bytes.size() && !may_begin_block(bytes.subspan(i, needed))) { ++i; }
        at += i;
        if (i + needed > bytes.size()) { continue; }
        GYROLOG_TRY(const std::optional<CaptureBlock> block, block_at(at, true));
        if (block) { return std::optional<std::uint64_t>(at); }
        ++at;
    }
    return std::optional<std::uint64_t>();
}

// Behind the last byte that is not zero.
Result<std::uint64_t> BlockScanner::end_of_data(std::uint64_t from) {
    std::uint64_t end = from;
    for (std::uint64_t at = from; at < accounts_.bytes_total;) {
        GYROLOG_TRY(const ByteView bytes, view(at, pcapng::block_bytes_max));
        if (bytes.empty()) { break; }
        const auto last =
            std::find_if(bytes.rbegin(), bytes.rend(), [](std::uint8_t byte) { return byte != 0; });
        if (last != bytes.rend()) { end = at + static_cast<std::uint64_t>(bytes.rend() - last); }
        at += bytes.size();
    }
    return end;
}

// A writer that dies leaves the beginning of one block; a file system that knew of more leaves zeros behind
// it. A block whose end is there was written whole: what is wrong with it came later.
Result<bool> BlockScanner::is_torn(std::uint64_t offset) {
    constexpr std::size_t length_known = 12;
    GYROLOG_TRY(const std::uint64_t data_end, end_of_data(offset));
    const std::uint64_t written = data_end - offset;
    if (written == 0) { return true; }
    GYROLOG_TRY(const ByteView begin, view(offset, length_known));
    if (begin.size() < length_known) { return written < length_known; }
    if (!(own_section_ || format_ == Format::pcap ? may_begin_block(begin)
                                                  : plausible_length(get<std::uint32_t>(begin, 4)))) {
        return false;
    }
    const std::uint64_t length = format_ == Format::pcap
                                     ? pcap_record_header_bytes + get<std::uint32_t>(begin, 8)
                                     : get<std::uint32_t>(begin, 4);
    if (written > length) { return false; }
    GYROLOG_TRY(const ByteView block, view(offset, static_cast<std::size_t>(length)));
    const bool whole = format_ == Format::pcapng && block.size() == length &&
                       get<std::uint32_t>(block, block.size() - 4) == length;
    return !whole;
}

void BlockScanner::enter(const CaptureBlock& block) {
    offset_ += block.bytes.size();
    accounts_.bytes_in_blocks += block.bytes.size();
    ++accounts_.blocks;
    vouched_seen_ = vouched_seen_ || block.vouched;
    closed_ = closes_capture(block);
    if (format_ == Format::pcap && block.kind == BlockKind::section) {
        const bool in_ns = get<std::uint32_t>(block.bytes, 0) == pcap_magic_ns;
        interfaces_ = {{get<std::uint32_t>(block.bytes, 20) & 0xFFFFU, in_ns ? 1'000'000'000U : 1'000'000U}};
    } else if (block.kind == BlockKind::section) {
        own_section_ = is_own(block.bytes);
        vouched_seen_ = false;
        interfaces_.clear();
    } else if (block.kind == BlockKind::interface_description && interfaces_.size() < interfaces_max) {
        Interface interface { get<std::uint16_t>(block.bytes, 8) };
        const auto options = pcapng::read_options(block.bytes.subspan(16, block.bytes.size() - 20));
        for (const pcapng::Option& option : options.value_or(std::vector<pcapng::Option>())) {
            if (option.code == pcapng::option_time_resolution && option.value.size() == 1) {
                interface.ticks_per_s = ticks_per_second(option.value[0]);
            }
        }
        interfaces_.push_back(interface);
    }
}

bool BlockScanner::closes_capture(const CaptureBlock& block) const {
    if (block.kind != BlockKind::statistics || !own_section_) { return false; }
    const auto comment = pcapng::statistics_comment(block.bytes);
    const auto checkpoint = comment ? read_checkpoint_json(*comment) : std::nullopt;
    return checkpoint && checkpoint->last;
}

void BlockScanner::enter_tail(bool torn) {
    accounts_.bytes_in_tail = accounts_.bytes_total - offset_;
    if (closed_) { accounts_.bytes_behind_close = accounts_.bytes_in_tail; }
    if (!torn) { ++accounts_.damaged_ranges; }
    offset_ = accounts_.bytes_total;
}

void BlockScanner::enter_damage(std::uint64_t offset, std::uint64_t bytes) {
    accounts_.bytes_damaged += bytes;
    ++accounts_.damaged_ranges;
    if (accounts_.damage.size() < damage_kept) { accounts_.damage.push_back({offset, bytes}); }
}

}  // namespace gyrolog
