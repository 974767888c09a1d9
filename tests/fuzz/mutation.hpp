// What the mutators that know a format share.
//
// libFuzzer changes bytes, and a changed byte fails the checksum that covers it. A target's own mutator
// (LLVMFuzzerCustomMutator) takes an input apart, has libFuzzer change what the checksums vouch for, and puts
// it together again with right lengths and checksums. In one of four calls it leaves all to libFuzzer, so
// that what is broken is tried as well; with GYROLOG_FUZZ_PLAIN in the environment it always does, which
// shows what the mutator is worth.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

#include "host/base/bytes.hpp"

// Of libFuzzer, or of the bounded driver: changes `size` bytes in place, to at most `size_max`; the new size.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t size_max);

namespace gyrolog {

class Mutation {
public:
    explicit Mutation(unsigned seed) : random_(seed) {}

    std::size_t below(std::size_t limit) { return random_() % limit; }
    bool one_in(std::size_t count) { return below(count) == 0; }
    bool is_plain() {
        static const bool always = std::getenv("GYROLOG_FUZZ_PLAIN") != nullptr;
        return one_in(4) || always;
    }

    static void change(Bytes& bytes, std::size_t bytes_max) {
        const std::size_t size = std::min(bytes.size(), bytes_max);
        bytes.resize(bytes_max);
        bytes.resize(LLVMFuzzerMutate(bytes.data(), size, bytes_max));
    }

    // Duplicates, removes or exchanges; `pieces` is not empty.
    template <typename Piece>
    void rearrange(std::vector<Piece>& pieces) {
        const std::size_t at = below(pieces.size());
        const std::size_t other = below(pieces.size());
        const auto place = pieces.begin() + static_cast<std::ptrdiff_t>(at);
        switch (below(3)) {
            case 0: {
                const Piece copy = pieces[other];
                pieces.insert(place, copy);
                break;
            }
            case 1:
                pieces.erase(place);
                break;
            default:
                std::swap(pieces[at], pieces[other]);
                break;
        }
    }

    // Into the fuzzer's buffer; what does not fit is cut off. libFuzzer takes no empty input.
    static std::size_t hand_back(const Bytes& made, std::uint8_t* data, std::size_t size,
                                 std::size_t size_max) {
        if (made.empty()) { return LLVMFuzzerMutate(data, size, size_max); }
        const std::size_t made_bytes = std::min(made.size(), size_max);
        std::copy_n(made.begin(), made_bytes, data);
        return made_bytes;
    }

private:
    std::mt19937 random_;
};

}  // namespace gyrolog
