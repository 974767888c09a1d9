#include "host/base/line_file.hpp"

#include <unistd.h>

namespace gyrolog {

Status LineFile::write_whole(std::string_view line) {
    if (!file_) {
        GYROLOG_TRY(ReplacingFile file, ReplacingFile::create(path_));
        file_.emplace(std::move(file));
    }
    if (Status written = file_->write(as_bytes(line)); !written.ok()) {
        const auto end = static_cast<off_t>(bytes_);
        const bool is_cut =
            ::ftruncate(file_->descriptor(), end) == 0 && ::lseek(file_->descriptor(), end, SEEK_SET) == end;
        if (!is_cut && bytes_ > 0) { written = in_context("half a line stands at its end", written.error()); }
        return written;
    }
    bytes_ += line.size();
    return file_->take_place();
}

Status LineFile::append(std::string_view line) {
    const Status done = write_whole(line);
    return done.ok() ? done : in_context("write '" + path_ + "'", done.error());
}

Status LineFile::close() {
    const Status done = file_ ? file_->commit() : Status();
    return done.ok() ? done : in_context("write '" + path_ + "'", done.error());
}

}  // namespace gyrolog
