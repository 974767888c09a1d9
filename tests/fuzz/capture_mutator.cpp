// Mutates the blocks of a capture file behind their lengths, hashes and checksums: packets, the records in
// them, the frames in those, comments.

#include <span>

#include "host/capture/byte_order.hpp"
#include "host/capture/pcapng.hpp"
#include "host/capture/usbmon_record.hpp"
#include "tests/fuzz/frame_mutation.hpp"

namespace {

using namespace gyrolog;

constexpr std::size_t change_bytes_max = 1024;

template <typename Number>
void put_at(Bytes& bytes, std::size_t offset, Number number) {
    Bytes field;
    put<Number>(field, number);
    std::copy(field.begin(), field.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
}

// What no length finds the end of is one piece, the last.
std::vector<Bytes> take_apart(ByteView file) {
    std::vector<Bytes> blocks;
    while (!file.empty()) {
        std::size_t length = file.size() >= 8 ? get<std::uint32_t>(file, 4) : 0;
        if (length < pcapng::block_bytes_min || length % 4 != 0 || length > file.size()) {
            length = file.size();
        }
        blocks.emplace_back(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(length));
        file = file.subspan(length);
    }
    return blocks;
}

// Length and time of a record agree with its packet's, as the scanner demands of an own file.
void mend_record(Bytes& record, std::uint64_t time_ns) {
    if (record.size() < usbmon_header_bytes) { return; }
    put_at<std::uint32_t>(record, 36, static_cast<std::uint32_t>(record.size() - usbmon_header_bytes));
    put_at<std::uint64_t>(record, 16, time_ns / 1'000'000'000);
    put_at<std::uint32_t>(record, 24, static_cast<std::uint32_t>(time_ns % 1'000'000'000 / 1000));
}

Bytes change_packet(Mutation& mutation, const pcapng::Packet& packet) {
    Bytes record(packet.bytes.begin(), packet.bytes.end());
    std::uint64_t time_ns = packet.time;
    if (mutation.one_in(4)) { time_ns += std::uint64_t{1} << mutation.below(64); }
    if (record.size() > usbmon_header_bytes && mutation.one_in(2)) {
        Bytes data(record.begin() + usbmon_header_bytes, record.end());
        if (mutation.one_in(2)) {
            data = change_frames(mutation, data);
        } else {
            Mutation::change(data, change_bytes_max);
        }
        record.resize(usbmon_header_bytes);
        record.insert(record.end(), data.begin(), data.end());
    } else {
        Mutation::change(record, change_bytes_max);
    }
    if (!mutation.one_in(8)) { mend_record(record, time_ns); }
    Bytes block;
    pcapng::append_packet(block, static_cast<std::int64_t>(time_ns),
                          [&](Bytes& out) { out.insert(out.end(), record.begin(), record.end()); });
    return block;
}

Bytes changed_text(std::string_view text) {
    Bytes bytes(text.begin(), text.end());
    Mutation::change(bytes, change_bytes_max);
    return bytes;
}

// Any block: its body, with both lengths.
Bytes change_body(const Bytes& block) {
    Bytes body(block.begin() + 8, block.end() - 4);
    Mutation::change(body, change_bytes_max);
    body.resize((body.size() + 3) / 4 * 4);
    Bytes made(block.begin(), block.begin() + 4);
    const auto length = static_cast<std::uint32_t>(body.size() + 12);
    put<std::uint32_t>(made, length);
    made.insert(made.end(), body.begin(), body.end());
    put<std::uint32_t>(made, length);
    return made;
}

Bytes change_block(Mutation& mutation, const Bytes& block) {
    if (block.size() < pcapng::block_bytes_min || mutation.one_in(8)) {
        Bytes raw = block;
        Mutation::change(raw, std::max(block.size(), change_bytes_max));
        return raw;
    }
    const auto type = get<std::uint32_t>(block, 0);
    if (type == pcapng::enhanced_packet && !mutation.one_in(8)) {
        if (const auto packet = pcapng::read_packet(block)) { return change_packet(mutation, *packet); }
    }
    Bytes made;
    if (type == pcapng::section_header) {
        if (const auto comment = pcapng::section_comment(block)) {
            pcapng::append_section_header(made, as_text(changed_text(*comment)), "fuzz");
            return made;
        }
    }
    if (type == pcapng::interface_statistics) {
        if (const auto comment = pcapng::statistics_comment(block)) {
            pcapng::append_statistics(made, 0, as_text(changed_text(*comment)), 0, 0);
            return made;
        }
    }
    return change_body(block);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t size_max,
                                               unsigned seed) {
    Mutation mutation(seed);
    std::vector<Bytes> blocks = take_apart({data, size});
    // A file of one piece is no pcapng: libFuzzer's.
    if (blocks.size() < 2 || mutation.is_plain()) { return LLVMFuzzerMutate(data, size, size_max); }
    if (mutation.one_in(4)) {
        mutation.rearrange(blocks);
    } else {
        Bytes& block = blocks[mutation.below(blocks.size())];
        block = change_block(mutation, block);
    }
    Bytes made;
    for (const Bytes& block : blocks) { made.insert(made.end(), block.begin(), block.end()); }
    return Mutation::hand_back(made, data, size, size_max);
}
