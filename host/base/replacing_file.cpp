#include "host/base/replacing_file.hpp"

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <random>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/base/storage_error.hpp"
#include "host/base/unfinished_files.hpp"

namespace gyrolog {
namespace {

// In the same folder, so that it can be renamed; beginning with the name that it shall have, if that leaves
// room for the rest (a name has 255 bytes at most).
std::string name_beside(const std::string& path) {
    constexpr std::size_t kept_bytes_most = 200;
    static constexpr char digits[] = "abcdefghijklmnopqrstuvwxyz234567";
    const std::filesystem::path wanted(path);
    std::string name = wanted.filename().string();
    if (name.size() > kept_bytes_most) { name.resize(kept_bytes_most); }
    name += '.';
    std::random_device random;
    for (int i = 0; i < 10; ++i) { name += digits[random() % 32U]; }
    return (wanted.parent_path() / (name + ".part")).string();
}

// Of the file that is replaced. Only root can give a file away. Where it stays this process's own, its group
// is another one, which may do what all others may.
void take_over_rights(int descriptor, const struct stat& replaced) {
    struct stat own {};
    if (::fstat(descriptor, &own) != 0) { return; }
    const bool same_owner = own.st_uid == replaced.st_uid && own.st_gid == replaced.st_gid;
    mode_t rights = replaced.st_mode & 0777U;
    if (!same_owner && ::fchown(descriptor, replaced.st_uid, replaced.st_gid) != 0) {
        const mode_t of_others = rights & 0007U;
        rights = (rights & 0700U) | (of_others << 3U) | of_others;
    }
    static_cast<void>(::fchmod(descriptor, rights));
}

// A rename is on the disk when its folder is. Not every file system can be asked for that.
void sync_folder_of(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) { return; }
    static_cast<void>(::fsync(descriptor));
    static_cast<void>(::close(descriptor));
}

std::optional<int> number_in(const std::string& digits) {
    int number = 0;
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (problem != std::errc{} || end != digits.data() + digits.size()) { return std::nullopt; }
    return number;
}

}  // namespace

std::optional<int> own_descriptor(const std::string& path) {
    namespace fs = std::filesystem;
    constexpr int links_most = 40;  // as the system follows
    const fs::path descriptors = fs::path("/proc") / std::to_string(::getpid()) / "fd";
    fs::path at = path;
    for (int link = 0; link < links_most; ++link) {
        std::error_code problem;
        const fs::path folder = fs::canonical(at.has_parent_path() ? at.parent_path() : ".", problem);
        if (problem) { return std::nullopt; }
        if (folder == descriptors) { return number_in(at.filename().string()); }
        const fs::path target = fs::read_symlink(folder / at.filename(), problem);
        if (problem) { return std::nullopt; }
        at = folder / target;
    }
    return std::nullopt;
}

struct ReplacingFile::State {
    std::string path;
    std::string written_path;
    std::optional<UnfinishedFile> unfinished;  // not for one that is written directly
    int descriptor = -1;

    ~State() {
        if (descriptor >= 0) { static_cast<void>(::close(descriptor)); }
        if (unfinished) { static_cast<void>(::unlink(written_path.c_str())); }
    }
};

ReplacingFile::ReplacingFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
ReplacingFile::ReplacingFile(ReplacingFile&&) noexcept = default;
ReplacingFile::~ReplacingFile() = default;

Result<ReplacingFile> ReplacingFile::create(const std::string& path) {
    auto state = std::make_unique<State>();
    state->path = path;
    if (const std::optional<int> own = own_descriptor(path)) {
        state->written_path = path;
        state->descriptor = ::fcntl(*own, F_DUPFD_CLOEXEC, 0);
        if (state->descriptor < 0) { return storage_error(errno); }
        return ReplacingFile(std::move(state));
    }
    struct stat existing {};
    const bool exists = ::stat(path.c_str(), &existing) == 0;
    if (exists && !S_ISREG(existing.st_mode)) {
        state->written_path = path;
        state->descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
        if (state->descriptor < 0) { return storage_error(errno); }
        return ReplacingFile(std::move(state));
    }
    if (std::filesystem::path(path).filename().empty()) { return storage_error(EISDIR); }
    for (int tries = 0; tries < 10 && state->descriptor < 0; ++tries) {
        state->written_path = name_beside(path);
        state->unfinished.emplace(state->written_path);
        constexpr int flags = O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
        state->descriptor = ::open(state->written_path.c_str(), flags, exists ? 0600 : 0666);
        const int problem = errno;
        if (state->descriptor >= 0) { break; }
        state->unfinished.reset();
        if (problem != EEXIST) { return storage_error(problem); }
    }
    if (state->descriptor < 0) { return storage_error(EEXIST); }
    if (exists) { take_over_rights(state->descriptor, existing); }
    return ReplacingFile(std::move(state));
}

int ReplacingFile::descriptor() const { return state_->descriptor; }
const std::string& ReplacingFile::written_path() const { return state_->written_path; }

Status ReplacingFile::write(ByteView contents) {
    while (!contents.empty()) {
        const ssize_t written = ::write(state_->descriptor, contents.data(), contents.size());
        if (written < 0) {
            if (errno == EINTR) { continue; }
            return storage_error(errno);
        }
        contents = contents.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

Status ReplacingFile::take_place() {
    if (!state_->unfinished) { return {}; }
    if (::rename(state_->written_path.c_str(), state_->path.c_str()) != 0) { return storage_error(errno); }
    state_->unfinished.reset();
    sync_folder_of(state_->path);
    return {};
}

Status ReplacingFile::commit() {
    int problem = 0;
    if (state_->unfinished && ::fsync(state_->descriptor) != 0) { problem = errno; }
    if (::close(state_->descriptor) != 0 && problem == 0) { problem = errno; }
    state_->descriptor = -1;
    if (problem != 0) { return storage_error(problem); }
    return take_place();
}

}  // namespace gyrolog
