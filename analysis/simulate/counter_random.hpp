// Random numbers by counting: draw k of a stream is a function of (seed, stream, k) and of nothing else, so
// any draw is reached directly and no order of calls, thread count, compiler or C library can change it.
//
// Generator: Philox4x32-10, J. K. Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC11 (2011).
// Normal numbers: inverse of the distribution function, by a cubic on each of 16 parts of every octave of the
// tail probability, fitted to AS 241 (portable_math.hpp) when the program starts. Its error stays below 2e-7
// of sigma and is a fixed smooth distortion, far below what 10^12 draws can show.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace gyrolog {

using PhiloxCounter = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

PhiloxCounter philox4x32_10(PhiloxCounter counter, PhiloxKey key);

// A seed that differs with each of the three: two words of the generator at a counter that no stream reaches.
std::uint64_t hashed_seed(std::uint64_t seed, std::uint32_t purpose, std::uint64_t number);

class RandomStream {
public:
    RandomStream(std::uint64_t seed, std::uint32_t stream_id);

    // Standard normal draws first_index, first_index + 1, ... One 32-bit word each; the outermost 2^-20 of
    // the probability is resolved with 32 bits more, so that the tails reach beyond 8 sigma without steps.
    void normals(std::uint64_t first_index, std::span<double> out) const;
    double normal(std::uint64_t index) const;

    // Uniform on (0, 1), 32 bits. The same words as the normal draws: use a stream for one or the other.
    double uniform(std::uint64_t index) const;

private:
    std::uint32_t word(std::uint64_t index) const;
    double tail_normal(std::uint64_t index, std::uint32_t word) const;

    PhiloxKey key_;
    std::uint32_t stream_id_;
};

}  // namespace gyrolog
