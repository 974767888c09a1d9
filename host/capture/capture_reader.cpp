#include "host/capture/capture_reader.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <gyrolog_protocol/usb_identity.h>

#include "host/base/clock.hpp"
#include "host/capture/byte_order.hpp"
#include "host/capture/head_records.hpp"
#include "host/capture/pcapng.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t marks_kept = 100'000;  // more than anybody types

bool is_device_descriptor(const Transfer& transfer) {
    return transfer.event == Transfer::Event::completion && transfer.kind == TransferKind::control &&
           transfer.data.size() == 18 && transfer.data[0] == 18 && transfer.data[1] == 1;
}

glp_usb_id id_in(ByteView device_descriptor) {
    return glp_usb_id_of(get<std::uint16_t>(device_descriptor, 8), get<std::uint16_t>(device_descriptor, 10));
}

// What a foreign capture shows of one device.
struct Candidate {
    glp_usb_id id = glp_usb_id_other;
    std::map<std::uint8_t, std::uint64_t> bulk_in_bytes;  // by endpoint

    std::pair<std::uint8_t, std::uint64_t> busiest() const {
        std::pair<std::uint8_t, std::uint64_t> best{};
        for (const auto& [endpoint, bytes] : bulk_in_bytes) {
            if (bytes > best.second) { best = {endpoint, bytes}; }
        }
        return best;
    }
};

}  // namespace

Result<CaptureReader> CaptureReader::open(const std::string& path) {
    GYROLOG_TRY(std::unique_ptr<InputFile> file, open_input_file(path));
    auto reader = open(std::move(file));
    if (!reader.ok()) { return in_context("open '" + path + "'", std::move(reader).error()); }
    return reader;
}

Result<CaptureReader> CaptureReader::open(std::unique_ptr<InputFile> file) {
    CaptureReader reader(std::move(file));
    GYROLOG_TRY(const std::optional<CaptureBlock> first, reader.scanner_.next());
    const bool foreign = first && !reader.scanner_.in_own_section();
    reader.scanner_.rewind();
    if (foreign) { GYROLOG_CHECK(reader.pick_device()); }
    GYROLOG_TRY(reader.first_, reader.advance());
    return reader;
}

Status CaptureReader::pick_device() {
    std::map<std::pair<std::uint16_t, std::uint8_t>, Candidate> candidates;
    while (true) {
        GYROLOG_TRY(const std::optional<CaptureBlock> block, scanner_.next());
        if (!block) { break; }
        if (block->kind != BlockKind::packet || block->link_type != link_type_usb_linux_mmapped) { continue; }
        const std::optional<UsbmonRecord> record = read_usbmon_record(block->packet);
        if (!record) { continue; }
        Candidate& candidate = candidates[{record->address.bus, record->address.device}];
        const Transfer& transfer = record->transfer;
        if (is_device_descriptor(transfer)) { candidate.id = id_in(transfer.data); }
        if (transfer.carries_stream()) { candidate.bulk_in_bytes[transfer.endpoint] += transfer.data.size(); }
    }
    scanner_.rewind();

    std::pair<glp_usb_id, std::uint64_t> best{glp_usb_id_other, 0};
    for (const auto& [address, candidate] : candidates) {
        const auto [endpoint, bytes] = candidate.busiest();
        const std::pair rank{candidate.id, bytes};
        if (bytes > 0 && rank > best) {
            best = rank;
            picked_ = UsbAddress{address.first, address.second};
            picked_endpoint_ = endpoint;
        }
    }
    if (!picked_) {
        return Error{ErrorCode::not_found, "no device in this capture sends bulk data (link type 220)"};
    }
    return {};
}

Result<std::optional<CapturedTransfer>> CaptureReader::next() {
    if (first_) { return std::exchange(first_, std::nullopt); }
    return advance();
}

Result<std::optional<CapturedTransfer>> CaptureReader::advance() {
    while (true) {
        GYROLOG_TRY(const std::optional<CaptureBlock> block, scanner_.next());
        if (!block) { return std::optional<CapturedTransfer>(); }
        if (block->kind == BlockKind::section) { enter_section(*block); }
        if (block->kind == BlockKind::statistics) { enter_statistics(*block); }
        if (block->kind != BlockKind::packet) { continue; }
        if (std::optional<CapturedTransfer> captured = take_packet(*block)) { return captured; }
    }
}

void CaptureReader::enter_section(const CaptureBlock& block) {
    monotonic_behind_ns_ = 0;
    if (!scanner_.in_own_section()) { return; }
    const auto comment = pcapng::section_comment(block.bytes);
    std::optional<CaptureMetadata> metadata = comment ? read_metadata_json(*comment) : std::nullopt;
    if (!metadata) { return; }
    monotonic_behind_ns_ = told_ns(metadata->started.realtime_ns - metadata->started.monotonic_ns);
    segment_ = metadata->segment;
    if (!metadata_) { metadata_ = std::move(metadata); }
}

void CaptureReader::enter_statistics(const CaptureBlock& block) {
    if (!scanner_.in_own_section()) { return; }
    if (const auto comment = pcapng::statistics_comment(block.bytes)) {
        if (auto checkpoint = read_checkpoint_json(*comment)) {
            checkpoint_ = checkpoint;
        } else if (auto mark = read_mark_json(*comment); mark && marks_.size() < marks_kept) {
            marks_.push_back(*std::move(mark));
        }
    }
}

std::optional<CapturedTransfer> CaptureReader::take_packet(const CaptureBlock& block) {
    const std::optional<UsbmonRecord> record =
        block.link_type == link_type_usb_linux_mmapped ? read_usbmon_record(block.packet) : std::nullopt;
    if (record && record->transfer.id >= head_record_id_min) { return std::nullopt; }
    const bool other_kind = !record || (record->transfer.kind != TransferKind::bulk &&
                                        record->transfer.kind != TransferKind::control);
    const bool other_device = picked_ && record && record->address != *picked_;
    const bool other_stream = picked_ && record && record->transfer.carries_stream() &&
                              record->transfer.endpoint != picked_endpoint_;
    if (other_kind || other_device || other_stream) {
        ++accounts_.foreign_packets;
        return std::nullopt;
    }

    CapturedTransfer captured{record->transfer, block.offset};
    const std::int64_t realtime_ns = told_ns(block.time_ns);
    captured.transfer.time = {told_ns(realtime_ns - monotonic_behind_ns_), realtime_ns};
    ++accounts_.transfers;
    const bool completed = captured.transfer.event == Transfer::Event::completion;
    if (completed && captured.transfer.status != 0) { ++accounts_.failed_transfers; }
    if (captured.transfer.carries_stream() && record->actual_bytes > captured.transfer.data.size()) {
        ++accounts_.truncated_transfers;
    }
    if (captured.transfer.carries_stream()) { accounts_.stream_bytes += captured.transfer.data.size(); }
    return captured;
}

CaptureAccounts CaptureReader::accounts() const {
    CaptureAccounts accounts = accounts_;
    accounts.blocks = scanner_.accounts();
    return accounts;
}

}  // namespace gyrolog
