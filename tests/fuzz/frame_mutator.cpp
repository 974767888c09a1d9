// The mutator of targets whose input is a byte stream.

#include "tests/fuzz/frame_mutation.hpp"

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t size_max,
                                               unsigned seed) {
    gyrolog::Mutation mutation(seed);
    if (mutation.is_plain()) { return LLVMFuzzerMutate(data, size, size_max); }
    return gyrolog::Mutation::hand_back(gyrolog::change_frames(mutation, {data, size}), data, size, size_max);
}
