#include "host/formats/recording_npy.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/formats/input_limits.hpp"

namespace gyrolog {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as the file has them");

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t preamble_bytes_most = magic.size() + 2 + 4;

struct TypeRow {
    std::string_view name;  // without the mark of the byte order
    NpyType type;
    std::size_t bytes;
};
constexpr std::array type_rows = {TypeRow{"f4", NpyType::float32, 4}, TypeRow{"f8", NpyType::float64, 8},
                                  TypeRow{"i2", NpyType::int16, 2}, TypeRow{"i4", NpyType::int32, 4}};

Error not_npy(const std::string& why) { return malformed("no whole .npy: " + why); }

std::size_t little_endian(std::string_view bytes) {
    std::size_t value = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) {
        value = value << 8U | static_cast<std::uint8_t>(bytes[i]);
    }
    return value;
}

// The header is a dictionary of Python with three keys, in any order.
class Dictionary {
public:
    explicit Dictionary(std::string_view text) : rest_(text) {}

    Result<NpyHeader> read() {
        if (!take('{')) { return bad("it begins with no dictionary"); }
        while (!take('}')) {
            const auto key = quoted();
            if (!key || !take(':')) { return bad("a key is missing"); }
            GYROLOG_CHECK(value_of(*key));
            if (!take(',') && (skip_blanks(), !rest_.starts_with('}'))) { return bad("a comma is missing"); }
        }
        if (!has_type_ || !has_order_ || !has_shape_) {
            return bad("descr, fortran_order or shape is missing");
        }
        return header_;
    }

private:
    static Error bad(const std::string& why) { return not_npy("its header is damaged: " + why); }

    void skip_blanks() {
        while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\n')) { rest_.remove_prefix(1); }
    }
    bool take(char c) {
        skip_blanks();
        if (!rest_.starts_with(c)) { return false; }
        rest_.remove_prefix(1);
        return true;
    }
    bool take_word(std::string_view word) {
        skip_blanks();
        if (!rest_.starts_with(word)) { return false; }
        rest_.remove_prefix(word.size());
        return true;
    }
    std::optional<std::string_view> quoted() {
        skip_blanks();
        if (rest_.empty() || (rest_.front() != '\'' && rest_.front() != '"')) { return std::nullopt; }
        const std::size_t end = rest_.find(rest_.front(), 1);
        if (end == std::string_view::npos) { return std::nullopt; }
        const std::string_view text = rest_.substr(1, end - 1);
        rest_.remove_prefix(end + 1);
        return text;
    }

    Status value_of(std::string_view key) {
        if (key == "descr" && !has_type_) {
            has_type_ = true;
            return type();
        }
        if (key == "fortran_order" && !has_order_) {
            has_order_ = true;
            header_.column_by_column = take_word("True");
            if (!header_.column_by_column && !take_word("False")) { return bad("fortran_order is no truth"); }
            return {};
        }
        if (key == "shape" && !has_shape_) {
            has_shape_ = true;
            return shape();
        }
        return bad("key " + in_quotes(key) + " is unknown or there twice");
    }

    Status type() {
        skip_blanks();
        if (rest_.starts_with('[')) {
            return Error{ErrorCode::unsupported,
                         "a structured type has no plain columns: save an array of numbers, such as "
                         "numpy.column_stack of its fields"};
        }
        const auto text = quoted();
        if (!text || text->empty()) { return bad("descr is no type"); }
        const std::string_view name = text->substr(1);
        const auto* row = std::ranges::find(type_rows, name, &TypeRow::name);
        if (row == type_rows.end() ||
            (text->front() != '<' && text->front() != '>' && text->front() != '=')) {
            return Error{ErrorCode::unsupported,
                         "its type is " + in_quotes(*text) +
                             ": save it as float64, float32, int16 or int32, such as a.astype('<f8')"};
        }
        if (text->front() == '>') {
            return Error{ErrorCode::unsupported, "its numbers are big endian (" + in_quotes(*text) +
                                                     "): save it as a.astype('<" + std::string(name) + "')"};
        }
        header_.type = row->type;
        return {};
    }

    std::optional<std::size_t> whole_number() {
        skip_blanks();
        std::size_t number = 0;
        const char* const end = rest_.data() + rest_.size();
        const auto [stop, problem] = std::from_chars(rest_.data(), end, number);
        if (problem != std::errc()) { return std::nullopt; }
        rest_.remove_prefix(static_cast<std::size_t>(stop - rest_.data()));
        return number;
    }

    Status shape() {
        if (!take('(')) { return bad("shape is no tuple"); }
        std::vector<std::size_t> sizes;
        while (!take(')')) {
            const auto size = whole_number();
            if (!size) { return bad("shape is no tuple of numbers"); }
            sizes.push_back(*size);
            if (!take(',') && (skip_blanks(), !rest_.starts_with(')'))) { return bad("shape is cut"); }
        }
        if (sizes.empty() || sizes.size() > 2) {
            return Error{ErrorCode::unsupported,
                         fmt::format("it has {}: save an array of N samples, or N rows of columns",
                                     counted(sizes.size(), "dimension"))};
        }
        header_.rows = sizes[0];
        header_.columns = sizes.size() == 2 ? sizes[1] : 1;
        if (header_.columns > input_limits.columns_most) {
            return malformed(
                fmt::format("it has {} columns, more than {}; N samples of k columns are an array "
                            "of N x k: save a.T",
                            header_.columns, input_limits.columns_most));
        }
        if (header_.columns == 0 || header_.rows == 0) { return malformed("it holds no numbers"); }
        if (header_.rows > input_limits.numbers_most / header_.columns) {
            return malformed(fmt::format("it has {} x {} numbers, more than any recording", header_.rows,
                                         header_.columns));
        }
        return {};
    }

    std::string_view rest_;
    NpyHeader header_;
    bool has_type_ = false;
    bool has_order_ = false;
    bool has_shape_ = false;
};

template <typename Number>
double number_at(const char* bytes) {
    Number number;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    std::memcpy(&number, bytes, sizeof number);
    return static_cast<double>(number);
}

// Takes the numbers in pieces of whole ones.
class Columns {
public:
    explicit Columns(const NpyHeader& header) : header_(header), columns_(header.columns) {
        for (std::size_t c = 0; c < columns_.size(); ++c) {
            columns_[c].header = fmt::format("column {}", c + 1);
            columns_[c].values.reserve(header.rows);
        }
    }

    void take(std::string_view bytes) {
        switch (header_.type) {
            case NpyType::float32:
                return take_all<float>(bytes);
            case NpyType::float64:
                return take_all<double>(bytes);
            case NpyType::int16:
                return take_all<std::int16_t>(bytes);
            case NpyType::int32:
                return take_all<std::int32_t>(bytes);
        }
    }
    std::vector<NumberColumn> result() && { return std::move(columns_); }

private:
    template <typename Number>
    void take_all(std::string_view bytes) {
        for (std::size_t at = 0; at + sizeof(Number) <= bytes.size(); at += sizeof(Number)) {
            columns_[column_].values.push_back(number_at<Number>(bytes.data() + at));
            const bool next = !header_.column_by_column || columns_[column_].values.size() == header_.rows;
            if (next && ++column_ == columns_.size()) { column_ = 0; }
        }
    }

    NpyHeader header_;
    std::vector<NumberColumn> columns_;
    std::size_t column_ = 0;
};

Status check_size(const NpyHeader& header, std::uintmax_t file_bytes) {
    const std::uintmax_t wanted = header.rows * header.columns * header.number_bytes();
    const std::uintmax_t there = file_bytes - header.header_bytes;
    if (there == wanted) { return {}; }
    return not_npy(fmt::format("{} x {} numbers take {} bytes, and {} are there{}", header.rows,
                               header.columns, wanted, there, there < wanted ? ": it is cut off" : ""));
}

// Without names nobody knows which column is what.
Status check_named(const NpyHeader& header, const RecordingReadOptions& options) {
    GYROLOG_TRY(const ColumnNames names, parse_column_names(options.choice.columns));
    if (!names.by_position.empty()) { return {}; }
    return invalid_argument(fmt::format(
        "an .npy does not name its columns, and this has {}: name them with --columns, such as t,gx,gy,gz, "
        "and the gyro's unit with --unit",
        header.columns));
}

Result<Recording> read_npy_file(const std::string& path, const RecordingReadOptions& options) {
    std::error_code failure;
    const std::uintmax_t file_bytes = std::filesystem::file_size(path, failure);
    std::ifstream file(path, std::ios::binary);
    if (failure || !file) { return Error{ErrorCode::failed, "it cannot be opened"}; }
    std::string begin(
        std::min<std::uintmax_t>(file_bytes, preamble_bytes_most + input_limits.npy_header_bytes_most), '\0');
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    GYROLOG_TRY(const NpyHeader header, parse_npy_header(begin));
    GYROLOG_CHECK(check_size(header, file_bytes));
    GYROLOG_CHECK(check_named(header, options));
    file.clear();
    file.seekg(static_cast<std::streamoff>(header.header_bytes));
    Columns columns(header);
    std::string piece(std::size_t{1} << 20, '\0');  // a multiple of every number's size
    for (std::uintmax_t left = file_bytes - header.header_bytes; left > 0;) {
        const auto size = static_cast<std::size_t>(std::min<std::uintmax_t>(left, piece.size()));
        if (!file.read(piece.data(), static_cast<std::streamsize>(size))) {
            return Error{ErrorCode::storage_failed, "reading failed"};
        }
        columns.take(std::string_view(piece).substr(0, size));
        left -= size;
    }
    return recording_of_numbers(std::move(columns).result(), path.substr(path.find_last_of('/') + 1),
                                options);
}

}  // namespace

std::size_t NpyHeader::number_bytes() const {
    return std::ranges::find(type_rows, type, &TypeRow::type)->bytes;
}

bool begins_as_npy(std::string_view file) { return file.starts_with(magic); }

Result<NpyHeader> parse_npy_header(std::string_view begin) {
    if (!begins_as_npy(begin)) { return not_npy("it does not begin as one"); }
    if (begin.size() < magic.size() + 4) { return not_npy("it is cut off in its header"); }
    const int major = static_cast<std::uint8_t>(begin[magic.size()]);
    if (major < 1 || major > 3) {
        return Error{ErrorCode::unsupported, fmt::format("its version is {}, and 1 to 3 are known", major)};
    }
    const std::size_t length_bytes = major == 1 ? 2 : 4;
    const std::string_view after = begin.substr(magic.size() + 2);
    if (after.size() < length_bytes) { return not_npy("it is cut off in its header"); }
    const std::size_t length = little_endian(after.substr(0, length_bytes));
    if (length > input_limits.npy_header_bytes_most) {
        return malformed(
            fmt::format("its header has {} bytes, more than {}", length, input_limits.npy_header_bytes_most));
    }
    if (after.size() - length_bytes < length) { return not_npy("it is cut off in its header"); }
    GYROLOG_TRY(NpyHeader header, Dictionary(after.substr(length_bytes, length)).read());
    header.header_bytes = magic.size() + 2 + length_bytes + length;
    return header;
}

Result<Recording> read_recording_npy(const std::string& path, const RecordingReadOptions& options) {
    Result<Recording> recording = read_npy_file(path, options);
    if (!recording.ok()) { return in_context("read '" + path + "'", std::move(recording).error()); }
    return recording;
}

Result<Recording> parse_recording_npy(std::string_view file, std::string name,
                                      const RecordingReadOptions& options) {
    GYROLOG_TRY(const NpyHeader header, parse_npy_header(file));
    GYROLOG_CHECK(check_size(header, file.size()));
    GYROLOG_CHECK(check_named(header, options));
    Columns columns(header);
    columns.take(file.substr(header.header_bytes));
    return recording_of_numbers(std::move(columns).result(), std::move(name), options);
}

}  // namespace gyrolog
