// The files that are being written and mean nothing until they are whole: what a signal that ends the program
// at once must take away.
#pragma once

#include <string>

namespace gyrolog {

// Holds a file's name where a signal handler can read it, from before the file is made until it is whole or
// removed. Beyond 16 at once, and for names beyond 4095 bytes, there is no room: such a file stays behind.
class UnfinishedFile {
public:
    explicit UnfinishedFile(const std::string& path);
    UnfinishedFile(UnfinishedFile&& other) noexcept : slot_(other.slot_) { other.slot_ = none; }
    UnfinishedFile& operator=(UnfinishedFile&&) = delete;
    ~UnfinishedFile();

private:
    static constexpr int none = -1;

    int slot_ = none;
};

// Removes them all. Async-signal-safe.
void remove_unfinished_files() noexcept;

}  // namespace gyrolog
