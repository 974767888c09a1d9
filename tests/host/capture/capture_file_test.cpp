// What a capture file promises: the good prefix of a torn one, one block's worth of a damaged one, and
// nothing invented.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "host/capture/byte_order.hpp"
#include "host/capture/capture_metadata.hpp"
#include "host/capture/pcapng.hpp"
#include "host/capture/recover.hpp"
#include "tests/host/capture/made_capture.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

ByteWriter into(Bytes& bytes) {
    return [&bytes](ByteView piece) {
        bytes.insert(bytes.end(), piece.begin(), piece.end());
        return Status();
    };
}

// Every transfer read is one that was written, in order. Returns how many were left out.
std::size_t expect_subsequence(const std::vector<KeptTransfer>& read,
                               const std::vector<KeptTransfer>& written) {
    std::size_t next = 0;
    for (const KeptTransfer& transfer : read) {
        while (next < written.size() && !written[next].same_content(transfer)) { ++next; }
        if (next == written.size()) {
            ADD_FAILURE() << "a transfer was invented or out of order: id " << transfer.transfer.id;
            return written.size();
        }
        // Damage below the microsecond is not noticed. The monotonic clock is known by the section header
        // only.
        const std::int64_t realtime_ns =
            made_start.realtime_ns + written[next].transfer.time.monotonic_ns - made_start.monotonic_ns;
        EXPECT_LT(std::abs(transfer.transfer.time.realtime_ns - realtime_ns), 1000);
        ++next;
    }
    return written.size() - read.size();
}

TEST(CaptureFile, GivesBackEveryTransferBitForBit) {
    const MadeCapture made = make_capture(40, 700);
    const auto read = read_capture(made.bytes);
    ASSERT_TRUE(read.ok()) << read.error().message;
    ASSERT_EQ(read->transfers.size(), made.transfers.size());
    for (std::size_t i = 0; i < made.transfers.size(); ++i) {
        ASSERT_EQ(read->transfers[i], made.transfers[i]) << i;
        EXPECT_EQ(
            read->transfers[i].transfer.time.realtime_ns - read->transfers[i].transfer.time.monotonic_ns,
            made_start.realtime_ns - made_start.monotonic_ns);
    }
    EXPECT_EQ(read->accounts.blocks.end, FileEnd::clean);
    EXPECT_EQ(read->accounts.failed_transfers, 1U);
    EXPECT_EQ(read->accounts.foreign_packets, 0U);
}

TEST(CaptureFile, RemembersWhoWasCaptured) {
    const auto read = read_capture(make_capture(3, 64).bytes);
    ASSERT_TRUE(read.ok());
    ASSERT_TRUE(read->metadata);
    const SourceIdentity told = made_identity();
    const SourceIdentity& source = read->metadata->source;
    EXPECT_EQ(source.uri, told.uri);
    EXPECT_EQ(source.vendor_id, told.vendor_id);
    EXPECT_EQ(source.product_id, told.product_id);
    EXPECT_EQ(source.bus_number, told.bus_number);
    EXPECT_EQ(source.device_address, told.device_address);
    EXPECT_EQ(source.manufacturer, told.manufacturer);
    EXPECT_EQ(source.product, told.product);
    EXPECT_EQ(source.serial, told.serial);
    EXPECT_EQ(source.device_descriptor, told.device_descriptor);
    EXPECT_EQ(source.configuration_descriptor, told.configuration_descriptor);
    EXPECT_EQ(read->metadata->started.realtime_ns, made_start.realtime_ns);
    EXPECT_EQ(read->metadata->started.monotonic_ns, made_start.monotonic_ns);
    ASSERT_TRUE(read->checkpoint);
    EXPECT_TRUE(read->checkpoint->last);
    EXPECT_EQ(read->checkpoint->transfers, 9U);
    EXPECT_EQ(read->checkpoint->stream_bytes, read->accounts.stream_bytes);
}

TEST(CaptureFile, KeepsItsGoodPrefixWhereverItIsCut) {
    const MadeCapture made = make_capture(6, 50);
    for (std::size_t cut = 0; cut <= made.bytes.size(); ++cut) {
        const Bytes head(made.bytes.begin(), made.bytes.begin() + static_cast<std::ptrdiff_t>(cut));
        const auto read = read_capture(head);
        ASSERT_TRUE(read.ok()) << "cut at byte " << cut << ": " << read.error().message;
        std::size_t complete = 0;
        while (complete < made.ends.size() && made.ends[complete] <= cut) { ++complete; }
        ASSERT_EQ(read->transfers.size(), complete) << "cut at byte " << cut;
        for (std::size_t i = 0; i < complete; ++i) { ASSERT_EQ(read->transfers[i], made.transfers[i]); }
        ASSERT_TRUE(read->accounts.blocks.balanced()) << "cut at byte " << cut;
        ASSERT_NE(read->accounts.blocks.end, FileEnd::damaged) << "cut at byte " << cut;
        const bool whole_blocks = read->accounts.blocks.bytes_in_tail == 0 && cut > 0;
        ASSERT_EQ(read->accounts.blocks.end, whole_blocks ? FileEnd::clean : FileEnd::torn_tail);
    }
}

TEST(CaptureFile, FindsNoPhantomsInAZeroFilledTail) {
    MadeCapture made = make_capture(6, 50);
    made.bytes.resize(made.ends[8]);
    made.bytes.resize(made.ends[8] + 5000, 0);
    const auto read = read_capture(made.bytes);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read->transfers.size(), 9U);
    EXPECT_EQ(read->accounts.blocks.end, FileEnd::torn_tail);
    EXPECT_EQ(read->accounts.blocks.bytes_in_tail, 5000U);
}

TEST(CaptureFile, WhatStandsBehindItsCloseIsNoPartOfIt) {
    const MadeCapture made = make_capture(6, 50);
    const auto with = [&](const Bytes& behind) {
        Bytes bytes = made.bytes;
        bytes.insert(bytes.end(), behind.begin(), behind.end());
        return read_capture(bytes);
    };
    const auto begin = made.bytes.begin() + static_cast<std::ptrdiff_t>(made.ends[3]);
    for (const Bytes& behind : {Bytes(5000, 0), Bytes(7, 'x'), Bytes(begin, begin + 40)}) {
        const auto read = with(behind);
        ASSERT_TRUE(read.ok());
        EXPECT_EQ(read->transfers.size(), made.transfers.size());
        EXPECT_EQ(read->accounts.blocks.end, FileEnd::torn_tail);
        EXPECT_EQ(read->accounts.blocks.bytes_behind_close, behind.size());
        EXPECT_TRUE(read->accounts.blocks.only_behind_close());
        EXPECT_TRUE(read->accounts.blocks.balanced());
    }
}

TEST(CaptureFile, LosesAtMostOneTransferToAnyFlippedBit) {
    const MadeCapture made = make_capture(3, 20);
    for (std::size_t bit = 0; bit < made.bytes.size() * 8; ++bit) {
        Bytes flipped = made.bytes;
        flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1U << (bit % 8)));
        const auto read = read_capture(flipped);
        ASSERT_TRUE(read.ok()) << "bit " << bit << ": " << read.error().message;
        const std::size_t lost = expect_subsequence(read->transfers, made.transfers);
        ASSERT_LE(lost, bit / 8 < made.head_end ? 0U : 1U) << "bit " << bit;
        ASSERT_TRUE(read->accounts.blocks.balanced()) << "bit " << bit;
        if (lost > 0) { ASSERT_NE(read->accounts.blocks.end, FileEnd::clean) << "bit " << bit; }
        if (testing::Test::HasFailure()) { FAIL() << "bit " << bit; }
    }
}

TEST(CaptureFile, GoesOnBehindDamageAndSaysWhereItWas) {
    MadeCapture made = make_capture(20, 300);
    const std::size_t begin = made.ends[10] + 3;
    const std::size_t end = made.ends[15] + 7;
    std::fill(made.bytes.begin() + static_cast<std::ptrdiff_t>(begin),
              made.bytes.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{0xA5});
    const auto read = read_capture(made.bytes);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(expect_subsequence(read->transfers, made.transfers), 6U);
    const BlockAccounts& blocks = read->accounts.blocks;
    EXPECT_EQ(blocks.end, FileEnd::damaged);
    ASSERT_EQ(blocks.damage.size(), 1U);
    EXPECT_LE(blocks.damage[0].offset, begin);
    EXPECT_EQ(blocks.damage[0].offset + blocks.damage[0].bytes, made.ends[16]);
    EXPECT_TRUE(blocks.balanced());
}

TEST(CaptureFile, FindsItsFeetAfterBytesWereCutOut) {
    MadeCapture made = make_capture(20, 300);
    const auto from = made.bytes.begin() + static_cast<std::ptrdiff_t>(made.ends[10] + 21);
    made.bytes.erase(from, from + 5);
    const auto read = read_capture(made.bytes);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(expect_subsequence(read->transfers, made.transfers), 1U);
    EXPECT_EQ(read->accounts.blocks.end, FileEnd::damaged);
}

TEST(CaptureFile, RefusesWhatIsNoCapture) {
    const auto text = read_capture(Bytes(5000, 'x'));
    ASSERT_FALSE(text.ok());
    EXPECT_EQ(text.error().code, ErrorCode::malformed);
    Bytes big_endian{0x0A, 0x0D, 0x0D, 0x0A, 0, 0, 0, 28, 0x1A, 0x2B, 0x3C, 0x4D};
    big_endian.resize(28);
    const auto swapped = read_capture(big_endian);
    ASSERT_FALSE(swapped.ok());
    EXPECT_EQ(swapped.error().code, ErrorCode::unsupported);
}

TEST(CaptureFile, ReadsTwoCapturesInOneFile) {
    const MadeCapture made = make_capture(5, 60);
    Bytes joined = made.bytes;
    joined.insert(joined.end(), made.bytes.begin(), made.bytes.end());
    const auto read = read_capture(joined);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read->transfers.size(), 2 * made.transfers.size());
    EXPECT_EQ(read->accounts.blocks.end, FileEnd::clean);
}

TEST(CaptureFile, GivesBackMarksWithTheirTimesAndPlaces) {
    const std::vector<KeptTransfer> transfers = made_transfers(6, 50);
    FakeDisk disk;
    auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
    ASSERT_TRUE(writer.ok());
    std::uint64_t stream_bytes = 0;
    for (std::size_t i = 0; i < transfers.size(); ++i) {
        ASSERT_TRUE(writer->append(transfers[i].view()).ok());
        if (transfers[i].view().carries_stream()) { stream_bytes += transfers[i].data.size(); }
        if (i == 7) {
            ASSERT_TRUE(writer->mark({{5'004'000'000, 1'700'000'000'127'456'789}, "lamp on, 20 °C", 0}).ok());
            ASSERT_TRUE(writer->checkpoint({}, made_start).ok());
            ASSERT_TRUE(writer->mark({made_start, std::string(10'000, 'x'), 0}).ok());
            EXPECT_GT(stream_bytes, 0U);
        }
    }
    ASSERT_TRUE(writer->close().ok());
    const auto read = read_capture(disk.contents);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read->transfers.size(), transfers.size());
    ASSERT_EQ(read->marks.size(), 2U);
    EXPECT_EQ(read->marks[0].text, "lamp on, 20 °C");
    EXPECT_EQ(read->marks[0].time.monotonic_ns, 5'004'000'000);
    EXPECT_EQ(read->marks[0].time.realtime_ns, 1'700'000'000'127'456'789);
    EXPECT_LT(read->marks[0].stream_bytes, stream_bytes);
    EXPECT_EQ(read->marks[1].text, std::string(4096, 'x'));
    ASSERT_TRUE(read->checkpoint.has_value());
    EXPECT_TRUE(read->checkpoint->last) << "a mark is no checkpoint";

    Bytes copy;
    ASSERT_TRUE(recover_capture(input_from_memory(disk.contents), into(copy)).ok());
    EXPECT_EQ(copy, disk.contents);
}

// One whose schema nobody knows yet costs nothing: that is how marks came after checkpoints.
TEST(CaptureFile, FlippedBitInAMarkCostsTheMarkAlone) {
    FakeDisk disk;
    auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
    ASSERT_TRUE(writer.ok());
    const std::vector<KeptTransfer> transfers = made_transfers(2, 50);
    for (const KeptTransfer& transfer : transfers) { ASSERT_TRUE(writer->append(transfer.view()).ok()); }
    const std::uint64_t begin = writer->bytes_written();
    ASSERT_TRUE(writer->mark({made_start, "here", 0}).ok());
    const std::uint64_t end = writer->bytes_written();
    for (const KeptTransfer& transfer : transfers) { ASSERT_TRUE(writer->append(transfer.view()).ok()); }
    ASSERT_TRUE(writer->close().ok());
    for (std::size_t bit = begin * 8; bit < end * 8; ++bit) {
        Bytes flipped = disk.contents;
        flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1U << (bit % 8)));
        const auto read = read_capture(flipped);
        ASSERT_TRUE(read.ok()) << "bit " << bit;
        ASSERT_EQ(read->transfers.size(), 2 * transfers.size()) << "bit " << bit;
        if (!read->marks.empty()) { ASSERT_EQ(read->marks[0].text, "here") << "bit " << bit; }
        ASSERT_TRUE(read->accounts.blocks.balanced()) << "bit " << bit;
    }
}

TEST(Recovery, KeepsEveryIntactBlockAndNothingElse) {
    MadeCapture made = make_capture(20, 300);
    made.bytes[made.ends[10] + 40] ^= 1U;
    made.bytes.resize(made.bytes.size() - 5);
    Bytes recovered;
    const auto report = recover_capture(input_from_memory(made.bytes), into(recovered));
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report->bytes_kept, recovered.size());
    EXPECT_EQ(report->bytes_kept, report->source.bytes_in_blocks);
    EXPECT_FALSE(report->header_rewritten);
    const auto read = read_capture(recovered);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(expect_subsequence(read->transfers, made.transfers), 1U);
    EXPECT_EQ(read->accounts.blocks.end, FileEnd::clean);
}

TEST(Recovery, LeavesNoFileOnAFullDisk) {
    const TemporaryFolder folder;
    MadeCapture made = make_capture(200, 300);
    made.bytes.resize(made.bytes.size() - 5);
    std::ofstream(folder.path("torn.pcapng"), std::ios::binary)
        .write(reinterpret_cast<const char*>(made.bytes.data()),
               static_cast<std::streamsize>(made.bytes.size()));
    const FileSizeLimit limit(4096);
    const auto report = recover_capture(folder.path("torn.pcapng"), folder.path("recovered.pcapng"));
    ASSERT_FALSE(report.ok());
    EXPECT_NE(report.error().message.find("recovered.pcapng"), std::string::npos) << report.error().message;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path("")), {}), 1);
}

TEST(Recovery, WritesANewHeaderWhenTheOldOneIsLost) {
    MadeCapture made = make_capture(5, 60);
    made.bytes.erase(made.bytes.begin(), made.bytes.begin() + static_cast<std::ptrdiff_t>(made.head_end - 3));
    Bytes recovered;
    const auto report = recover_capture(input_from_memory(made.bytes), into(recovered));
    ASSERT_TRUE(report.ok()) << report.error().message;
    EXPECT_TRUE(report->header_rewritten);
    const auto read = read_capture(recovered);
    ASSERT_TRUE(read.ok());
    ASSERT_EQ(read->transfers.size(), made.transfers.size());
    EXPECT_TRUE(read->transfers.back().same_content(made.transfers.back()));
    EXPECT_EQ(read->accounts.blocks.end, FileEnd::clean);
}

// 16 384 blocks begin here, one in each 32 bytes, each half a megabyte long, with both lengths and a place
// for its hash, which is wrong: worked out for each, the hashes would be of gigabytes.
Bytes overlapping_blocks(std::size_t bytes) {
    constexpr std::uint32_t length = 512 * 1024;
    constexpr std::uint32_t hash_option = 3 | 5U << 16U;  // five bytes
    constexpr std::uint32_t crc_32_of_0 = 2;              // the hash's kind, and its first bytes
    Bytes made(16, 0xFF);                                 // no length that leads past it
    while (made.size() < bytes) {
        // Each one's hash stands in the time stamp of the last that lies within it.
        for (const std::uint32_t word :
             {pcapng::enhanced_packet, length, 0U, hash_option, crc_32_of_0, length - 48U, 0U, length}) {
            put<std::uint32_t>(made, word);
        }
    }
    return made;
}

TEST(CaptureFile, SearchesWhatWasMadeToBeSlowInProportionToItsSize) {
    const MadeCapture made = make_capture(20, 300);
    const Bytes trap = overlapping_blocks(std::size_t{1} << 20U);
    for (const std::size_t at : {std::size_t{0}, made.head_end, made.ends[10], made.bytes.size()}) {
        Bytes file = made.bytes;
        file.insert(file.begin() + static_cast<std::ptrdiff_t>(at), trap.begin(), trap.end());
        const auto read = read_capture(file);
        ASSERT_TRUE(read.ok()) << at << ": " << read.error().message;
        const BlockAccounts& blocks = read->accounts.blocks;
        EXPECT_TRUE(blocks.balanced());
        EXPECT_GT(blocks.bytes_judged_in_vain, trap.size()) << at << ": the trap is none";
        EXPECT_LE(blocks.bytes_judged_in_vain, bytes_judged_in_vain_max(file.size())) << at;
        EXPECT_EQ(read->transfers.size(), made.transfers.size()) << at << ": intact blocks were left out";
    }
}

// What a sound file costs, and one with damage everywhere: far below the limit.
TEST(CaptureFile, HonestDamageIsJudgedOnce) {
    MadeCapture made = make_capture(200, 700);
    EXPECT_EQ(read_capture(made.bytes)->accounts.blocks.bytes_judged_in_vain, 0U);
    for (const std::size_t end : made.ends) { made.bytes[end - 30] ^= 1U; }
    const auto read = read_capture(made.bytes);
    ASSERT_TRUE(read.ok());
    EXPECT_GT(read->accounts.blocks.bytes_judged_in_vain, made.bytes.size() / 2);
    EXPECT_LE(read->accounts.blocks.bytes_judged_in_vain, made.bytes.size());
}

// A header that tells any time: UndefinedBehaviorSanitizer looks on.
TEST(CaptureFile, ClocksThatCannotBeAreBroughtIntoRange) {
    constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    const std::vector<HostTime> told{{least, most}, {most, least}, {least, least}, {most, most}, {1, least}};
    const MadeCapture made = make_capture(3, 100);
    const auto header_bytes = get<std::uint32_t>(made.bytes, 4);
    for (const HostTime time : told) {
        CaptureMetadata metadata;
        metadata.program = "made";
        metadata.started = time;
        Bytes file;
        pcapng::append_section_header(file, metadata_json(metadata), "made");
        file.insert(file.end(), made.bytes.begin() + header_bytes, made.bytes.end());
        const auto read = read_capture(file);
        ASSERT_TRUE(read.ok());
        ASSERT_EQ(read->transfers.size(), made.transfers.size());
        for (const KeptTransfer& transfer : read->transfers) {
            for (const std::int64_t ns :
                 {transfer.transfer.time.monotonic_ns, transfer.transfer.time.realtime_ns}) {
                EXPECT_LE(ns, told_ns_max);
                EXPECT_GE(ns, -told_ns_max);
            }
        }
    }
}

}  // namespace
}  // namespace gyrolog
