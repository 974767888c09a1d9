// Small captures made on the spot, and reading them back.
#pragma once

#include <array>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "host/capture/capture_reader.hpp"
#include "host/capture/capture_writer.hpp"
#include "tests/host/capture/fake_disk.hpp"

namespace gyrolog {

// A transfer that owns its data.
struct KeptTransfer {
    Transfer transfer;
    Bytes data;

    explicit KeptTransfer(const Transfer& from) : transfer(from), data(from.data.begin(), from.data.end()) {
        transfer.data = {};
    }
    Transfer view() const {
        Transfer copy = transfer;
        copy.data = data;
        return copy;
    }
    // Times apart: a file keeps one clock.
    bool same_content(const KeptTransfer& other) const {
        const Transfer& a = transfer;
        const Transfer& b = other.transfer;
        return a.event == b.event && a.kind == b.kind && a.endpoint == b.endpoint && a.id == b.id &&
               a.status == b.status && a.requested_bytes == b.requested_bytes && a.setup == b.setup &&
               data == other.data;
    }
    bool operator==(const KeptTransfer& other) const {
        return same_content(other) && transfer.time.monotonic_ns == other.transfer.time.monotonic_ns;
    }
};

inline SourceIdentity made_identity() {
    SourceIdentity identity;
    identity.uri = "usb:S1";
    identity.vendor_id = 0x1FC9;
    identity.product_id = 0x0083;
    identity.bus_number = 3;
    identity.device_address = 17;
    identity.manufacturer = "NXP";
    identity.product = "gyrolog \"board\"";
    identity.serial = "S1";
    identity.device_descriptor = {18, 1, 0, 2, 2, 0, 0, 64, 0xC9, 0x1F, 0x83, 0, 0, 1, 1, 2, 3, 1};
    identity.configuration_descriptor = {9, 2, 9, 0, 0, 1, 0, 0x80, 50};
    return identity;
}

constexpr HostTime made_start{5'000'000'000, 1'700'000'000'123'456'789};

// Submissions and completions of `count` bulk IN transfers, a control transfer first, an error last.
inline std::vector<KeptTransfer> made_transfers(std::size_t count, std::size_t bytes_max,
                                                std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::vector<KeptTransfer> all;
    std::int64_t now_ns = made_start.monotonic_ns;
    const auto add = [&](Transfer transfer, Bytes data) {
        now_ns += 1'000'123;
        transfer.time.monotonic_ns = now_ns;
        transfer.data = data;
        all.emplace_back(transfer);
    };
    Transfer control;
    control.event = Transfer::Event::submission;
    control.kind = TransferKind::control;
    control.id = 7;
    control.setup = {0x21, 0x22, 1, 0, 0, 0, 0, 0};
    add(control, {});
    control.event = Transfer::Event::completion;
    control.setup = {};
    add(control, {});
    for (std::size_t i = 0; i < count; ++i) {
        Transfer bulk;
        bulk.endpoint = 0x81;
        bulk.id = 0x1000 + i;
        bulk.event = Transfer::Event::submission;
        bulk.requested_bytes = 512;
        add(bulk, {});
        bulk.event = Transfer::Event::completion;
        bulk.requested_bytes = 0;
        Bytes data(random() % (bytes_max + 1));
        for (std::uint8_t& byte : data) { byte = static_cast<std::uint8_t>(random()); }
        add(bulk, data);
    }
    Transfer failed;
    failed.endpoint = 0x81;
    failed.id = 0x99;
    failed.status = -75;
    add(failed, {1, 2, 3});
    return all;
}

struct MadeCapture {
    Bytes bytes;
    std::vector<KeptTransfer> transfers;
    std::vector<std::size_t> ends;  // of the file behind each transfer's block
    std::size_t head_end = 0;
};

inline MadeCapture make_capture(std::size_t count, std::size_t bytes_max) {
    MadeCapture made;
    made.transfers = made_transfers(count, bytes_max);
    FakeDisk disk;
    auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
    EXPECT_TRUE(writer.ok());
    made.head_end = disk.contents.size();
    for (std::size_t i = 0; i < made.transfers.size(); ++i) {
        EXPECT_TRUE(writer->append(made.transfers[i].view()).ok());
        made.ends.push_back(static_cast<std::size_t>(writer->bytes_written()));
        if (i % 5 == 4) { EXPECT_TRUE(writer->checkpoint({.stream_bytes = i}, made_start).ok()); }
    }
    EXPECT_TRUE(writer->close().ok());
    made.bytes = disk.contents;
    return made;
}

struct ReadCapture {
    std::vector<KeptTransfer> transfers;
    std::vector<std::uint64_t> offsets;
    CaptureAccounts accounts;
    std::optional<CaptureMetadata> metadata;
    std::optional<CaptureCheckpoint> checkpoint;
    std::vector<CaptureMark> marks;
};

inline Result<ReadCapture> read_capture(std::unique_ptr<InputFile> file) {
    ReadCapture read;
    GYROLOG_TRY(CaptureReader reader, CaptureReader::open(std::move(file)));
    while (true) {
        GYROLOG_TRY(const std::optional<CapturedTransfer> captured, reader.next());
        if (!captured) { break; }
        read.transfers.emplace_back(captured->transfer);
        read.offsets.push_back(captured->offset);
    }
    read.accounts = reader.accounts();
    read.metadata = reader.metadata();
    read.checkpoint = reader.checkpoint();
    read.marks = reader.marks();
    return read;
}

inline Result<ReadCapture> read_capture(const Bytes& bytes) { return read_capture(input_from_memory(bytes)); }

}  // namespace gyrolog
