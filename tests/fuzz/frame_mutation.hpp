// Mutates the frames within a byte stream behind their checksums: types, flags, numbers and payloads.
#pragma once

#include "tests/fuzz/mutation.hpp"

namespace gyrolog {

// One change; every frame has a right checksum afterwards.
Bytes change_frames(Mutation& mutation, ByteView stream);

}  // namespace gyrolog
