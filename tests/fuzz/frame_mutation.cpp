#include "tests/fuzz/frame_mutation.hpp"

#include <array>
#include <iterator>

#include <gyrolog_protocol/crc.h>
#include <gyrolog_protocol/frame.h>

#include "host/capture/byte_order.hpp"

namespace gyrolog {
namespace {

// What stands between two delimiters: a frame, or bytes that are none.
struct Piece {
    bool is_frame = false;
    std::uint8_t type = 0;
    std::uint16_t flags = 0;
    std::uint32_t sequence = 0;
    Bytes bytes;  // of a frame its payload
};

// A wrong checksum is overlooked: it is mended when the frame is encoded again.
Piece read_piece(ByteView encoded) {
    std::array<std::uint8_t, GLP_FRAME_BODY_MAX> body{};
    const glp_cobs_result plain = glp_cobs_decode(encoded.data(), encoded.size(), body.data(), body.size());
    if (plain.status != glp_status_ok || plain.size < GLP_FRAME_BODY_MIN) {
        return {.bytes = Bytes(encoded.begin(), encoded.end())};
    }
    const ByteView view(body);
    const ByteView payload =
        view.subspan(GLP_FRAME_HEADER_BYTES, plain.size - GLP_FRAME_HEADER_BYTES - GLP_FRAME_CRC_BYTES);
    return {true, body[1], get<std::uint16_t>(view, 2), get<std::uint32_t>(view, 4),
            Bytes(payload.begin(), payload.end())};
}

std::vector<Piece> take_apart(ByteView stream) {
    std::vector<Piece> pieces;
    for (auto begin = stream.begin(); begin != stream.end();) {
        const auto end = std::find(begin, stream.end(), std::uint8_t{0});
        if (end != begin) { pieces.push_back(read_piece({begin, end})); }
        begin = end == stream.end() ? end : end + 1;
    }
    return pieces;
}

Bytes put_together(const std::vector<Piece>& pieces) {
    Bytes stream;
    for (const Piece& piece : pieces) {
        if (!piece.is_frame) {
            stream.push_back(0);
            stream.insert(stream.end(), piece.bytes.begin(), piece.bytes.end());
            continue;
        }
        const glp_frame frame{piece.type, piece.flags, piece.sequence, piece.bytes.data(),
                              piece.bytes.size()};
        std::array<std::uint8_t, GLP_FRAME_WIRE_MAX> wire{};
        const glp_cobs_result encoded = glp_frame_encode(&frame, wire.data(), wire.size());
        stream.insert(stream.end(), wire.begin(), wire.begin() + static_cast<std::ptrdiff_t>(encoded.size));
    }
    return stream;
}

std::uint8_t known_type(Mutation& mutation) {
    constexpr std::uint8_t types[] = {glp_frame_hello,     glp_frame_config,    glp_frame_samples,
                                      glp_frame_status,    glp_frame_event,     glp_frame_reply,
                                      glp_frame_get_hello, glp_frame_start,     glp_frame_configure,
                                      glp_frame_stop,      glp_frame_get_status};
    return types[mutation.below(std::size(types))];
}

void change_frame(Mutation& mutation, Piece& piece) {
    switch (mutation.below(5)) {
        case 0:
            piece.type =
                mutation.one_in(8) ? static_cast<std::uint8_t>(mutation.below(256)) : known_type(mutation);
            break;
        case 1:
            piece.flags = static_cast<std::uint16_t>(piece.flags ^ (1U << mutation.below(16)));
            break;
        case 2:
            piece.sequence +=
                mutation.one_in(4) ? 0x8000'0000U : static_cast<std::uint32_t>(mutation.below(4));
            break;
        default:
            Mutation::change(piece.bytes, GLP_FRAME_PAYLOAD_MAX);
            break;
    }
}

}  // namespace

Bytes change_frames(Mutation& mutation, ByteView stream) {
    std::vector<Piece> pieces = take_apart(stream);
    if (pieces.empty() || mutation.one_in(8)) {
        Piece frame{true, known_type(mutation), 0, static_cast<std::uint32_t>(mutation.below(100)), {}};
        Mutation::change(frame.bytes, 40);
        pieces.insert(pieces.begin() + static_cast<std::ptrdiff_t>(mutation.below(pieces.size() + 1)), frame);
    } else if (mutation.one_in(4)) {
        mutation.rearrange(pieces);
    } else if (Piece& piece = pieces[mutation.below(pieces.size())]; piece.is_frame) {
        change_frame(mutation, piece);
    } else {
        Mutation::change(piece.bytes, GLP_FRAME_ENCODED_MAX + 10);
    }
    return put_together(pieces);
}

}  // namespace gyrolog
