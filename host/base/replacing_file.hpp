// A file that takes the place of another once it is whole.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// The descriptor of this process that a path stands for, as /dev/stdout and /dev/fd/3 do, whatever file lies
// behind it.
std::optional<int> own_descriptor(const std::string& path);

// Until commit() the new file stands beside the old one, under a name that nobody can foresee; a failure and
// a signal take it away and leave what was there. It has the mode and, where the system lets us, the owner of
// the file that it replaces. A symbolic link is replaced, not followed. A path that is no regular file (a
// pipe, /dev/stdout) is written directly.
//
// The errors' messages are the reason alone: not_found (no such directory), permission_denied, disk_full,
// storage_failed.
class ReplacingFile {
public:
    static Result<ReplacingFile> create(const std::string& path);
    ReplacingFile(ReplacingFile&&) noexcept;
    ReplacingFile& operator=(ReplacingFile&&) = delete;
    // Without commit() the new file is removed.
    ~ReplacingFile();

    // For libraries that write themselves, by descriptor or by name. It stays this object's.
    int descriptor() const;
    const std::string& written_path() const;

    Status write(ByteView contents);
    // Under its name from now on, whole or not: for a file that grows in its place.
    Status take_place();
    // On the disk, and in its place.
    Status commit();

private:
    struct State;
    explicit ReplacingFile(std::unique_ptr<State> state);

    std::unique_ptr<State> state_;
};

}  // namespace gyrolog
