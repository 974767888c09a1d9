// Captures that other programs wrote, and this one's captures in other programs.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "host/capture/byte_order.hpp"
#include "tests/host/capture/made_capture.hpp"
#include "tests/support/needs.hpp"

namespace gyrolog {
namespace {

constexpr UsbAddress board_address{1, 9};
constexpr UsbAddress disk_address{1, 4};

struct ForeignPacket {
    std::int64_t time_us;
    Bytes record;
};

ForeignPacket packet(std::int64_t time_us, UsbAddress address, const Transfer& transfer) {
    ForeignPacket made{time_us, {}};
    append_usbmon_record(made.record, transfer, address, time_us * 1000);
    return made;
}

struct UsbId {
    std::uint16_t vendor;
    std::uint16_t product;
};
constexpr UsbId own_id{0x1209, 0x6779};
constexpr UsbId former_id{0x1FC9, 0x0083};
constexpr UsbId disks_id{0x1234, 0x0083};

// A bus with a disk that moves more data than the board, both told by their descriptors unless `anonymous`.
std::vector<ForeignPacket> made_bus(const std::vector<KeptTransfer>& board, bool anonymous,
                                    UsbId board_id = own_id, UsbId disk_id = disks_id) {
    std::vector<ForeignPacket> packets;
    std::int64_t time_us = 1'700'000'000'000'000;
    const auto describe = [&](UsbAddress address, UsbId id) {
        Bytes descriptor{18, 1, 0, 2, 2, 0, 0, 64};
        put<std::uint16_t>(descriptor, id.vendor);
        put<std::uint16_t>(descriptor, id.product);
        for (const std::uint8_t byte : Bytes{0, 1, 1, 2, 3, 1}) { descriptor.push_back(byte); }
        Transfer transfer;
        transfer.kind = TransferKind::control;
        transfer.endpoint = 0x80;
        transfer.data = descriptor;
        packets.push_back(packet(++time_us, address, transfer));
    };
    if (!anonymous) {
        describe(disk_address, disk_id);
        describe(board_address, board_id);
    }
    const Bytes block(anonymous ? 10 : 4096, 0xEE);
    for (const KeptTransfer& kept : board) {
        Transfer disk;
        disk.endpoint = 0x81;
        disk.data = block;
        packets.push_back(packet(++time_us, disk_address, disk));
        packets.push_back(packet(++time_us, board_address, kept.view()));
    }
    return packets;
}

void put_padded(Bytes& out, const Bytes& bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
    while (out.size() % 4 != 0) { out.push_back(0); }
}

void put_block(Bytes& out, std::uint32_t type, const Bytes& body) {
    put<std::uint32_t>(out, type);
    put<std::uint32_t>(out, static_cast<std::uint32_t>(body.size() + 12));
    out.insert(out.end(), body.begin(), body.end());
    put<std::uint32_t>(out, static_cast<std::uint32_t>(body.size() + 12));
}

// As dumpcap writes it: microseconds by default, no hashes, a block of a kind that means nothing here. All
// packets come from the last of the interfaces.
Bytes foreign_pcapng(const std::vector<ForeignPacket>& packets, std::size_t interfaces = 1) {
    Bytes file;
    Bytes body;
    put<std::uint32_t>(body, 0x1A2B3C4D);
    put<std::uint32_t>(body, 1);
    put<std::int64_t>(body, -1);
    put_block(file, 0x0A0D0D0A, body);
    body.clear();
    put<std::uint32_t>(body, 220);
    put<std::uint32_t>(body, 262144);
    for (std::size_t i = 0; i < interfaces; ++i) { put_block(file, 1, body); }
    put_block(file, 4, Bytes(8, 0));
    for (const ForeignPacket& made : packets) {
        body.clear();
        put<std::uint32_t>(body, static_cast<std::uint32_t>(interfaces - 1));
        put<std::uint32_t>(body, static_cast<std::uint32_t>(made.time_us >> 32));
        put<std::uint32_t>(body, static_cast<std::uint32_t>(made.time_us));
        put<std::uint32_t>(body, static_cast<std::uint32_t>(made.record.size()));
        put<std::uint32_t>(body, static_cast<std::uint32_t>(made.record.size()));
        put_padded(body, made.record);
        put_block(file, 6, body);
    }
    return file;
}

Bytes foreign_pcap(const std::vector<ForeignPacket>& packets) {
    Bytes file;
    put<std::uint32_t>(file, 0xA1B2C3D4);
    put<std::uint32_t>(file, 0x00040002);
    put<std::int64_t>(file, 0);
    put<std::uint32_t>(file, 262144);
    put<std::uint32_t>(file, 220);
    for (const ForeignPacket& made : packets) {
        put<std::uint32_t>(file, static_cast<std::uint32_t>(made.time_us / 1'000'000));
        put<std::uint32_t>(file, static_cast<std::uint32_t>(made.time_us % 1'000'000));
        put<std::uint32_t>(file, static_cast<std::uint32_t>(made.record.size()));
        put<std::uint32_t>(file, static_cast<std::uint32_t>(made.record.size()));
        file.insert(file.end(), made.record.begin(), made.record.end());
    }
    return file;
}

Bytes stream_of(const std::vector<KeptTransfer>& transfers) {
    Bytes stream;
    for (const KeptTransfer& kept : transfers) {
        if (kept.transfer.carries_stream()) {
            stream.insert(stream.end(), kept.data.begin(), kept.data.end());
        }
    }
    return stream;
}

TEST(ForeignCapture, GivesTheBoardsTransfersAmongThoseOfOtherDevices) {
    const std::vector<KeptTransfer> board = made_transfers(20, 300);
    for (const Bytes& file : {foreign_pcapng(made_bus(board, false)), foreign_pcap(made_bus(board, false))}) {
        const auto read = read_capture(file);
        ASSERT_TRUE(read.ok()) << read.error().message;
        EXPECT_EQ(stream_of(read->transfers), stream_of(board));
        ASSERT_EQ(read->transfers.size(), board.size() + 1);  // and the descriptor
        for (std::size_t i = 0; i < board.size(); ++i) {
            ASSERT_TRUE(read->transfers[i + 1].same_content(board[i])) << i;
        }
        EXPECT_EQ(read->transfers.front().transfer.time.realtime_ns, 1'700'000'000'000'002'000);
        EXPECT_EQ(read->accounts.foreign_packets, board.size() + 1);
        EXPECT_EQ(read->accounts.blocks.end, FileEnd::clean);
        EXPECT_TRUE(read->accounts.blocks.balanced());
        EXPECT_FALSE(read->metadata);
    }
}

TEST(ForeignCapture, KnowsABoardByItsIdNowAndFormerly) {
    const std::vector<KeptTransfer> board = made_transfers(20, 300);
    for (const auto& bus : {made_bus(board, false, own_id), made_bus(board, false, former_id),
                            // NXP's example of a serial port beside it
                            made_bus(board, false, own_id, former_id)}) {
        const auto read = read_capture(foreign_pcapng(bus));
        ASSERT_TRUE(read.ok()) << read.error().message;
        EXPECT_EQ(stream_of(read->transfers), stream_of(board));
    }
}

TEST(ForeignCapture, TakesTheBusiestDeviceWhenNoneIsDescribed) {
    const std::vector<KeptTransfer> board = made_transfers(20, 300);
    const auto read = read_capture(foreign_pcapng(made_bus(board, true)));
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(stream_of(read->transfers), stream_of(board));
}

// Whoever makes a file chooses how many it describes.
TEST(ForeignCapture, KnowsABoundedNumberOfInterfaces) {
    const std::vector<KeptTransfer> board = made_transfers(20, 300);
    const auto bus = made_bus(board, false);
    const auto read = read_capture(foreign_pcapng(bus, BlockScanner::interfaces_max));
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(stream_of(read->transfers), stream_of(board));
    const auto beyond = read_capture(foreign_pcapng(bus, BlockScanner::interfaces_max + 1));
    ASSERT_FALSE(beyond.ok());
    EXPECT_EQ(beyond.error().code, ErrorCode::not_found) << "packets of an interface that was forgotten";
}

TEST(ForeignCapture, SaysWhenThereIsNoBulkData) {
    const auto read = read_capture(foreign_pcapng({}));
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().code, ErrorCode::not_found);
}

TEST(ForeignCapture, FindsNoPhantomsInTheZerosBehindAPcapFile) {
    const std::vector<KeptTransfer> board = made_transfers(20, 300);
    Bytes file = foreign_pcap(made_bus(board, false));
    file.resize(file.size() + 4000, 0);
    const auto read = read_capture(file);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read->transfers.size(), board.size() + 1);
    EXPECT_EQ(read->accounts.blocks.bytes_in_tail, 4000U);
    EXPECT_EQ(read->accounts.blocks.end, FileEnd::torn_tail);
}

TEST(ForeignCapture, CountsTransfersThatWereNotKeptWhole) {
    Transfer transfer;
    transfer.endpoint = 0x81;
    const Bytes data(100, 1);
    transfer.data = data;
    ForeignPacket made = packet(1'700'000'000'000'000, board_address, transfer);
    made.record[32] = 200;  // moved; 100 of them kept
    const auto read = read_capture(foreign_pcapng({made}));
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read->accounts.truncated_transfers, 1U);
}

// Wireshark's tools on a file of ours.
class InWireshark : public testing::Test {
protected:
    InWireshark() {
        std::string name = (std::filesystem::temp_directory_path() / "gyrolog-wireshark-XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~InWireshark() override { std::filesystem::remove_all(folder_); }

    std::string write(const Bytes& bytes) const {
        const std::string path = folder_ / "made.pcapng";
        std::ofstream(path, std::ios::binary) << as_text(bytes);
        return path;
    }
    std::string output_of(const std::string& command) const {
        const std::string path = folder_ / "output";
        EXPECT_EQ(
            std::system(("HOME=" + folder_.string() + " " + command + " >" + path + " 2>/dev/null").c_str()),
            0)
            << command;
        std::stringstream text;
        text << std::ifstream(path).rdbuf();
        return text.str();
    }

    std::filesystem::path folder_;
};

TEST_F(InWireshark, TsharkSeesEveryPacketAndEveryByteOfTheStream) {
    if (!has_program("tshark")) { GTEST_SKIP() << needs_program("tshark"); }
    const MadeCapture made = make_capture(40, 700);
    std::istringstream rows(output_of("tshark -r " + write(made.bytes) +
                                      " -T fields -e frame.time_epoch -e usb.idVendor -e usb.urb_type -e "
                                      "usb.endpoint_address -e usb.urb_status -e usb.capdata"));
    const auto read = read_capture(made.bytes);
    ASSERT_TRUE(read.ok());
    std::size_t count = 0;
    bool board_seen = false;
    Bytes stream;
    for (std::string row; std::getline(rows, row); ++count) {
        std::istringstream cells(row);
        std::array<std::string, 6> cell;
        for (std::string& text : cell) { std::getline(cells, text, '\t'); }
        board_seen = board_seen || cell[1] == "0x1fc9";
        if (count == 6) { EXPECT_EQ(cell[0].substr(0, 20), "1700000000.124456912"); }
        for (std::size_t i = 0; i + 1 < cell[5].size(); i += 2) {
            stream.push_back(static_cast<std::uint8_t>(std::stoi(cell[5].substr(i, 2), nullptr, 16)));
        }
    }
    EXPECT_EQ(count, made.transfers.size() + 6);  // and the head
    EXPECT_TRUE(board_seen);
    EXPECT_EQ(stream, stream_of(made.transfers));
}

TEST_F(InWireshark, CapinfosCountsTheSamePackets) {
    if (!has_program("capinfos")) { GTEST_SKIP() << needs_program("capinfos"); }
    const MadeCapture made = make_capture(40, 700);
    const std::string told = output_of("capinfos -TmQ -c -E " + write(made.bytes));
    EXPECT_NE(told.find(std::to_string(made.transfers.size() + 6)), std::string::npos) << told;
    EXPECT_NE(told.find("usb-linux-mmap"), std::string::npos) << told;
}

TEST_F(InWireshark, AFileThatEditcapRewroteIsStillRead) {
    if (!has_program("editcap")) { GTEST_SKIP() << needs_program("editcap"); }
    const MadeCapture made = make_capture(40, 700);
    const std::string rewritten = folder_ / "rewritten.pcapng";
    static_cast<void>(output_of("editcap " + write(made.bytes) + " " + rewritten));
    auto file = open_input_file(rewritten);
    ASSERT_TRUE(file.ok());
    const auto read = read_capture(std::move(file).value());
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(stream_of(read->transfers), stream_of(made.transfers));
    EXPECT_EQ(read->accounts.blocks.end, FileEnd::clean);
}

}  // namespace
}  // namespace gyrolog
