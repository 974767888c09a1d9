// What it costs to check and decode a stream, in bytes per second. A memcpy of the same bytes in the same run
// says how fast this machine's memory is; a board on USB full speed sends 1.2 MB/s at the very most.

#include <array>
#include <cstring>
#include <random>

#include <benchmark/benchmark.h>
#include <gyrolog_protocol/crc.h>

#include "host/decode/stream_decoder.hpp"
#include "host/virtual_board/virtual_board.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t transfer_bytes = 16384;  // as the host posts them

// Frames of every possible length with random payload, of a type that no version knows: framing, stuffing and
// checksum alone.
Bytes random_frames() {
    std::mt19937 random(1);
    std::uniform_int_distribution<std::size_t> length(0, GLP_FRAME_PAYLOAD_MAX);
    std::uniform_int_distribution<unsigned> byte(0, 255);
    Bytes stream;
    std::array<std::uint8_t, GLP_FRAME_PAYLOAD_MAX> payload{};
    std::array<std::uint8_t, GLP_FRAME_WIRE_MAX> wire{};
    for (std::uint32_t sequence = 0; stream.size() < 4'000'000; ++sequence) {
        const std::size_t size = length(random);
        for (std::size_t i = 0; i < size; ++i) { payload[i] = static_cast<std::uint8_t>(byte(random)); }
        const glp_frame frame{0x7F, 0, sequence, payload.data(), size};
        const std::size_t wire_bytes = glp_frame_encode(&frame, wire.data(), wire.size()).size;
        stream.insert(stream.end(), wire.begin(), wire.begin() + static_cast<std::ptrdiff_t>(wire_bytes));
    }
    return stream;
}

// Two minutes of the virtual board at 1 kHz.
Bytes board_stream() {
    VirtualBoardOptions options;
    options.rate_hz = 1000.0;
    options.dlpf_hz = 184;
    auto board = VirtualBoard::create(std::move(options));
    if (!board.ok()) { return {}; }
    (*board)->on_line_state(true);
    Bytes stream;
    Bytes buffer(transfer_bytes);
    for (int tenths = 0; tenths < 1200; ++tenths) {
        (*board)->advance_to((*board)->now_ns() + 100'000'000);
        while (const std::size_t size = (*board)->in_endpoint().take_bytes(buffer)) {
            stream.insert(stream.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size));
        }
    }
    return stream;
}

const Bytes& random_stream() {
    static const Bytes stream = random_frames();
    return stream;
}
const Bytes& real_stream() {
    static const Bytes stream = board_stream();
    return stream;
}

void feed_transfers(StreamDecoder& decoder, ByteView stream) {
    HostTime arrival;
    for (std::size_t at = 0; at < stream.size(); at += transfer_bytes) {
        arrival.monotonic_ns += 1'000'000'000;
        decoder.feed(stream.subspan(at, std::min(transfer_bytes, stream.size() - at)), arrival);
    }
}

void count_bytes(benchmark::State& state, const Bytes& stream) {
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(stream.size()));
}

void copy(benchmark::State& state, const Bytes& stream) {
    Bytes target(stream.size());
    for (auto _ : state) {
        std::memcpy(target.data(), stream.data(), stream.size());
        benchmark::ClobberMemory();
    }
    count_bytes(state, stream);
}

void decode_for_accounts(benchmark::State& state, const Bytes& stream) {
    for (auto _ : state) {
        StreamDecoder decoder;
        feed_transfers(decoder, stream);
        const LinkReport report = decoder.report();
        if (report.frames.good < 1000 || report.frames.corrupted > 0 || report.frames.missing > 0) {
            state.SkipWithError("the stream did not decode");
        }
    }
    count_bytes(state, stream);
}

void decode_into_recording(benchmark::State& state, const Bytes& stream) {
    std::uint64_t samples = 0;
    for (auto _ : state) {
        StreamDecoder decoder({.keep_samples = true});
        feed_transfers(decoder, stream);
        samples = decoder.report().samples.good;
        const auto recording = decoder.take_recording("benchmark");
        if (!recording.ok()) { state.SkipWithError("no recording came of it"); }
        benchmark::DoNotOptimize(recording);
    }
    count_bytes(state, stream);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples));
}

BENCHMARK_CAPTURE(copy, random_payload, random_stream())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode_for_accounts, random_payload, random_stream())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(copy, board_at_1kHz, real_stream())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode_for_accounts, board_at_1kHz, real_stream())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode_into_recording, board_at_1kHz, real_stream())->Unit(benchmark::kMillisecond);

// The checksum's definition, one bit at a time.
std::uint32_t crc32_bit_by_bit(ByteView bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) { crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U); }
    }
    return ~crc;
}

void crc32_of_the_protocol(benchmark::State& state) {
    const Bytes& stream = random_stream();
    if (glp_crc32(stream.data(), stream.size()) != crc32_bit_by_bit(stream)) {
        state.SkipWithError("the two checksums differ");
    }
    for (auto _ : state) { benchmark::DoNotOptimize(glp_crc32(stream.data(), stream.size())); }
    count_bytes(state, stream);
}

void crc32_by_definition(benchmark::State& state) {
    const Bytes& stream = random_stream();
    for (auto _ : state) { benchmark::DoNotOptimize(crc32_bit_by_bit(stream)); }
    count_bytes(state, stream);
}

BENCHMARK(crc32_of_the_protocol)->Unit(benchmark::kMillisecond);
BENCHMARK(crc32_by_definition)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gyrolog
