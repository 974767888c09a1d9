#include "host/formats/text_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <archive.h>
#include <archive_entry.h>

#include "host/base/storage_error.hpp"
#include "host/formats/input_limits.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t read_bytes = std::size_t{1} << 18;

// What libarchive says of compressed bytes, beside EILSEQ: ARCHIVE_ERRNO_MISC of a header that is not
// installed.
constexpr int not_of_the_system = -1;

archive* handle(void* pointer) { return static_cast<archive*>(pointer); }

Error error_of(archive* file) {
    const int number = archive_errno(file);
    const char* text = archive_error_string(file);
    std::string message = text == nullptr ? "unknown error" : text;
    switch (number) {
        case ENOENT:
            return {ErrorCode::not_found, "no such file"};
        case EACCES:
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
            return storage_error(number);
        case EISDIR:
            return {ErrorCode::failed, "it is a directory"};
        case EIO:
            return {ErrorCode::storage_failed, std::move(message)};
        case not_of_the_system:
        case EILSEQ:
            // "No progress is possible" tells nobody that the file is short.
            return malformed("its compressed text is damaged or cut off (" + message +
                             "): fetch or write the file again");
        default:
            return {ErrorCode::failed, std::move(message)};
    }
}

// Those that libarchive knows itself. For others it would run programs, and which is for the file to say.
struct Compression {
    const char* name;
    std::string_view ending;
    int code;
    int (*know)(archive*);
    int (*write)(archive*);
};
constexpr std::array compressions{
    Compression{"gzip", ".gz", ARCHIVE_FILTER_GZIP, archive_read_support_filter_gzip,
                archive_write_add_filter_gzip},
    Compression{"xz", ".xz", ARCHIVE_FILTER_XZ, archive_read_support_filter_xz, archive_write_add_filter_xz},
    Compression{"zstd", ".zst", ARCHIVE_FILTER_ZSTD, archive_read_support_filter_zstd,
                archive_write_add_filter_zstd},
    Compression{"bzip2", ".bz2", ARCHIVE_FILTER_BZIP2, archive_read_support_filter_bzip2,
                archive_write_add_filter_bzip2}};

// Null: it names none.
const Compression* compression_named(const std::string& path) {
    const auto* const found = std::ranges::find_if(
        compressions, [&](const Compression& one) { return path.ends_with(one.ending); });
    return found == compressions.end() ? nullptr : found;
}

// Null: it is not compressed.
const Compression* compression_found(archive* file) {
    const auto* const found = std::ranges::find_if(
        compressions, [&](const Compression& one) { return archive_filter_code(file, 0) == one.code; });
    return found == compressions.end() ? nullptr : found;
}

Status know_compressions(archive* file) {
    for (const Compression& one : compressions) {
        if (one.know(file) != ARCHIVE_OK) {
            return Error{ErrorCode::unsupported,
                         std::string("this system's libarchive cannot read ") + one.name};
        }
    }
    return {};
}

// What is named one way and packed another was renamed or cut, or is not what the user takes it for.
Status check_name(archive* file, const std::string& path) {
    std::error_code unknown;
    if (own_descriptor(path) || !std::filesystem::is_regular_file(path, unknown)) { return {}; }
    const Compression* const named = compression_named(path);
    const Compression* const found = compression_found(file);
    if (named == found) { return {}; }
    if (named == nullptr) {
        return malformed(std::string("it is compressed with ") + found->name +
                         ", and its name does not say so: it should end in " + std::string(found->ending));
    }
    return malformed(
        "its name ends in " + std::string(named->ending) + ", and it is " +
        (found == nullptr ? std::string("not compressed") : std::string("compressed with ") + found->name) +
        ": give it the name of what it is");
}

// Memory in proportion to the file, whatever was packed into it. -1 is the file, 0 what comes out.
Status check_ratio(archive* file) {
    const auto unpacked = static_cast<std::uint64_t>(archive_filter_bytes(file, 0));
    const auto read = static_cast<std::uint64_t>(archive_filter_bytes(file, -1));
    if (unpacked <= input_limits.unpacked_free_bytes + input_limits.unpacked_ratio_most * read) { return {}; }
    return malformed("it unpacks to more than " + std::to_string(input_limits.unpacked_ratio_most) +
                     " times its size, as no recording does: decompress it first");
}

}  // namespace

bool begins_as_capture(std::string_view bytes) { return bytes.starts_with("\x0A\x0D\x0D\x0A"); }

void TextReader::Close::operator()(void* archive) const { archive_read_free(handle(archive)); }

Result<TextReader> TextReader::open(const std::string& path) {
    TextReader reader;
    archive* file = archive_read_new();
    reader.archive_.reset(file);
    GYROLOG_CHECK(know_compressions(file));
    archive_read_support_format_raw(file);
    archive_read_support_format_empty(file);
    if (archive_read_open_filename(file, path.c_str(), read_bytes) != ARCHIVE_OK) { return error_of(file); }
    // The last filter is the file itself.
    if (archive_filter_count(file) > 2) {
        return Error{ErrorCode::malformed, "compressed more than once: decompress it first"};
    }
    archive_entry* entry = nullptr;
    const int header = archive_read_next_header(file, &entry);
    if (header == ARCHIVE_OK) { GYROLOG_CHECK(check_name(file, path)); }
    if (header != ARCHIVE_OK && header != ARCHIVE_EOF) { return error_of(file); }
    reader.buffer_.resize(header == ARCHIVE_EOF ? 0 : read_bytes);
    return reader;
}

Result<std::string_view> TextReader::read() {
    if (buffer_.empty()) { return std::string_view(); }
    const la_ssize_t bytes = archive_read_data(handle(archive_.get()), buffer_.data(), buffer_.size());
    if (bytes < 0) { return error_of(handle(archive_.get())); }
    GYROLOG_CHECK(check_ratio(handle(archive_.get())));
    return std::string_view(buffer_.data(), static_cast<std::size_t>(bytes));
}

void TextWriter::Close::operator()(void* archive) const { archive_write_free(handle(archive)); }

Result<TextWriter> TextWriter::create(const std::string& path, TextGrowth growth) {
    TextWriter writer;
    writer.growth_ = growth;
    GYROLOG_TRY(ReplacingFile replacing, ReplacingFile::create(path));
    writer.file_.emplace(std::move(replacing));
    archive* file = archive_write_new();
    writer.archive_.reset(file);
    archive_write_set_format_raw(file);
    if (const Compression* const named = compression_named(path)) { named->write(file); }
    // Without this the file would be filled up to a multiple of a tape's block.
    archive_write_set_bytes_in_last_block(file, 1);
    if (growth == TextGrowth::growing) { archive_write_set_bytes_per_block(file, 0); }
    if (archive_write_open_fd(file, writer.file_->descriptor()) != ARCHIVE_OK) { return error_of(file); }
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, "text");
    archive_entry_set_filetype(entry, AE_IFREG);
    const int status = archive_write_header(file, entry);
    archive_entry_free(entry);
    if (status != ARCHIVE_OK) { return error_of(file); }
    return writer;
}

Status TextWriter::write(std::string_view text) {
    if (text.empty()) { return {}; }
    while (!text.empty()) {
        const la_ssize_t bytes = archive_write_data(handle(archive_.get()), text.data(), text.size());
        if (bytes < 0) { return error_of(handle(archive_.get())); }
        text.remove_prefix(static_cast<std::size_t>(bytes));
    }
    const bool first = !std::exchange(any_text_, true);
    return first && growth_ == TextGrowth::growing ? file_->take_place() : Status();
}

Status TextWriter::close() {
    if (archive_write_close(handle(archive_.get())) != ARCHIVE_OK) {
        return error_of(handle(archive_.get()));
    }
    return any_text_ || growth_ == TextGrowth::whole ? file_->commit() : Status();
}

}  // namespace gyrolog
