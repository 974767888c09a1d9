// A file in memory, for what is read by its path only.
#pragma once

#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "host/base/bytes.hpp"
#include "tests/fuzz/require.hpp"

namespace gyrolog {

class MemoryFile {
public:
    MemoryFile() : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) { GYROLOG_REQUIRE(descriptor_ >= 0); }
    explicit MemoryFile(ByteView contents) : MemoryFile() {
        GYROLOG_REQUIRE(::write(descriptor_, contents.data(), contents.size()) ==
                        static_cast<ssize_t>(contents.size()));
        GYROLOG_REQUIRE(::lseek(descriptor_, 0, SEEK_SET) == 0);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() { ::close(descriptor_); }

    int descriptor() const { return descriptor_; }
    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
    Bytes contents() const {
        Bytes bytes(static_cast<std::size_t>(::lseek(descriptor_, 0, SEEK_END)));
        GYROLOG_REQUIRE(::pread(descriptor_, bytes.data(), bytes.size(), 0) ==
                        static_cast<ssize_t>(bytes.size()));
        return bytes;
    }

private:
    int descriptor_;
};

}  // namespace gyrolog
