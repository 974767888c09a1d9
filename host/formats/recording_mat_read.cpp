#include "host/formats/recording_mat_read.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <matio.h>
#include <unistd.h>

#include "host/base/confined_process.hpp"
#include "host/base/printable.hpp"
#include "host/formats/column_dialect.hpp"
#include "host/formats/input_limits.hpp"

namespace gyrolog {
namespace {

struct CloseReadFile {
    void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeReadVariable {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using ReadVariable = std::unique_ptr<matvar_t, FreeReadVariable>;

struct MatMatrix {
    std::string name;
    std::size_t rows = 0;
    std::size_t columns = 0;
    std::vector<double> values;  // column by column
};

struct Variables {
    std::vector<MatMatrix> matrices;
    std::vector<std::pair<std::string, double>> scalars;
    std::string gyro_axes;            // of gyrolog's own files
    std::vector<std::string> others;  // names of what is no matrix of numbers
};

template <typename Number>
std::vector<double> converted(const matvar_t& variable, std::size_t count) {
    const auto* data = static_cast<const Number*>(variable.data);
    return {data, data + count};
}

// Empty for what is no real number.
std::vector<double> doubles_of(const matvar_t& variable, std::size_t count) {
    switch (variable.class_type) {
        case MAT_C_DOUBLE:
            return converted<double>(variable, count);
        case MAT_C_SINGLE:
            return converted<float>(variable, count);
        case MAT_C_INT8:
            return converted<std::int8_t>(variable, count);
        case MAT_C_UINT8:
            return converted<std::uint8_t>(variable, count);
        case MAT_C_INT16:
            return converted<std::int16_t>(variable, count);
        case MAT_C_UINT16:
            return converted<std::uint16_t>(variable, count);
        case MAT_C_INT32:
            return converted<std::int32_t>(variable, count);
        case MAT_C_UINT32:
            return converted<std::uint32_t>(variable, count);
        case MAT_C_INT64:
            return converted<std::int64_t>(variable, count);
        case MAT_C_UINT64:
            return converted<std::uint64_t>(variable, count);
        default:
            return {};
    }
}

bool is_numeric(const matvar_t& variable) {
    return variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64 &&
           variable.isComplex == 0 && variable.rank == 2;
}

std::string characters_of(const matvar_t& variable) {
    if (variable.class_type != MAT_C_CHAR || variable.data == nullptr || variable.data_size != 1) {
        return {};
    }
    return {static_cast<const char*>(variable.data), variable.nbytes};
}

// A compressed variable may hold more numbers than its file has bytes.
std::size_t numbers_most(const std::string& path) {
    std::error_code failure;
    const std::uintmax_t file_bytes = std::filesystem::file_size(path, failure);
    if (failure || file_bytes > input_limits.numbers_most) { return input_limits.numbers_most; }
    const std::size_t unpacked_bytes =
        input_limits.unpacked_free_bytes + input_limits.unpacked_ratio_most * file_bytes;
    return std::min(input_limits.numbers_most, unpacked_bytes / sizeof(double));
}

Status take(Variables& variables, mat_t* file, matvar_t& variable, std::size_t most) {
    const std::string name = variable.name == nullptr ? "" : variable.name;
    if (name.size() > input_limits.mat_name_bytes_most) {
        return malformed(fmt::format("a variable has a name of {} characters; MATLAB has {} at most",
                                     name.size(), input_limits.mat_name_bytes_most));
    }
    const bool is_axes = name == "gyro_axes" && variable.class_type == MAT_C_CHAR;
    if (!is_axes && !is_numeric(variable)) {
        variables.others.push_back(name);
        return {};
    }
    const std::size_t rows = variable.rank == 2 ? variable.dims[0] : 0;
    const std::size_t columns = variable.rank == 2 ? variable.dims[1] : 0;
    if (rows == 0 || columns == 0) { return {}; }
    if (rows > most / columns) {
        return malformed(fmt::format("variable {} has {} x {} numbers, more than any recording of its size",
                                     in_quotes(name), rows, columns));
    }
    if (Mat_VarReadDataAll(file, &variable) != 0 || variable.data == nullptr ||
        variable.nbytes < rows * columns * static_cast<std::size_t>(variable.data_size)) {
        return malformed("variable " + in_quotes(name) + " is damaged or cut off");
    }
    if (is_axes) {
        variables.gyro_axes = characters_of(variable);
        return {};
    }
    std::vector<double> values = doubles_of(variable, rows * columns);
    if (values.size() == 1) {
        variables.scalars.emplace_back(name, values.front());
    } else {
        variables.matrices.push_back({name, rows, columns, std::move(values)});
    }
    return {};
}

// Samples go down a matrix; one that is wider than high lies on its side.
void stand_up(MatMatrix& matrix) {
    if (matrix.columns <= matrix.rows) { return; }
    std::vector<double> turned(matrix.values.size());
    for (std::size_t r = 0; r < matrix.rows; ++r) {
        for (std::size_t c = 0; c < matrix.columns; ++c) {
            turned[r * matrix.columns + c] = matrix.values[c * matrix.rows + r];
        }
    }
    matrix.values = std::move(turned);
    std::swap(matrix.rows, matrix.columns);
}

bool is_understood(const std::string& name) { return csv_column(name) || dialect_name(name); }

std::string name_of_column(const MatMatrix& matrix, std::size_t column) {
    constexpr std::string_view axes = "xyz";
    if (matrix.columns == 1 && (is_understood(matrix.name) || !is_understood(matrix.name + "_x"))) {
        return matrix.name;
    }
    if (matrix.columns <= axes.size()) { return matrix.name + "_" + axes[column]; }
    return fmt::format("{}_{}", matrix.name, column + 1);
}

// gyrolog's own: SI units, which the names do not tell.
std::vector<std::string> own_names(const MatMatrix& matrix, const std::string& gyro_axes) {
    if (matrix.name == "gyro") {
        std::vector<std::string> names;
        std::size_t at = 0;
        while (at < gyro_axes.size()) {
            const std::size_t blank = std::min(gyro_axes.find(' ', at), gyro_axes.size());
            names.push_back("g" + gyro_axes.substr(at, blank - at) + "_rad_s");
            at = blank + 1;
        }
        return names;
    }
    if (matrix.name == "t") { return {"t_s"}; }
    if (matrix.name == "temperature_degC") { return {"temp_C"}; }
    for (const char* unit : {"_m_s2", "_rad_s", ""}) {
        const auto meaning = csv_column(matrix.name + unit);
        if (meaning && meaning->kind != CsvColumn::Kind::rate) { return {matrix.name + unit}; }
    }
    return {matrix.name};
}

std::vector<NumberColumn> columns_of(std::vector<MatMatrix>& matrices, const std::string& gyro_axes) {
    std::vector<NumberColumn> columns;
    for (MatMatrix& matrix : matrices) {
        stand_up(matrix);
        std::vector<std::string> names;
        if (!gyro_axes.empty()) { names = own_names(matrix, gyro_axes); }
        if (names.size() != matrix.columns) {
            names.clear();
            for (std::size_t c = 0; c < matrix.columns && c < input_limits.columns_most; ++c) {
                names.push_back(name_of_column(matrix, c));
            }
        }
        for (std::size_t c = 0; c < names.size(); ++c) {
            const auto begin = matrix.values.begin() + static_cast<std::ptrdiff_t>(c * matrix.rows);
            columns.push_back({names[c], {begin, begin + static_cast<std::ptrdiff_t>(matrix.rows)}});
        }
    }
    return columns;
}

bool names_gyro(const std::string& name) {
    const auto meaning = csv_column(name);
    if (meaning) { return meaning->is_gyro(); }
    const auto told = dialect_name(name);
    return told && told->quantity[0] == 'g';
}

bool names_time(const std::string& name) {
    const auto meaning = csv_column(name);
    if (meaning) { return meaning->kind == CsvColumn::Kind::time_stamp; }
    const auto told = dialect_name(name);
    return told && told->quantity == "t";
}

bool names_quantity(const std::string& name) { return csv_column(name) || dialect_name(name); }

// As many samples as the gyro has, or else the longest; what has another length and no name of a quantity is
// something else.
Status keep_samples(std::vector<NumberColumn>& columns) {
    if (columns.empty()) { return {}; }
    const auto longest = std::ranges::max_element(
        columns, {}, [](const NumberColumn& column) { return column.values.size(); });
    const auto gyro = std::ranges::find_if(columns, names_gyro, &NumberColumn::header);
    const NumberColumn& samples = gyro != columns.end() ? *gyro : *longest;
    const std::size_t rows = samples.values.size();
    for (const NumberColumn& column : columns) {
        if (column.values.size() == rows || !names_quantity(column.header)) { continue; }
        return malformed(fmt::format("{} has {} numbers, and {} has {}", in_quotes(column.header),
                                     column.values.size(), in_quotes(samples.header), rows));
    }
    std::erase_if(columns, [&](const NumberColumn& column) { return column.values.size() != rows; });
    return {};
}

std::optional<double> rate_of(const Variables& variables) {
    constexpr std::array names = {"rate_hz",       "Fs",          "fs",
                                  "fs_hz",         "Fs_Hz",       "rate",
                                  "sampling_rate", "sample_rate", "sampling_frequency",
                                  "samplingRate",  "sampleRate"};
    for (const auto& [name, value] : variables.scalars) {
        if (std::ranges::find(names, name) != names.end() && std::isfinite(value) && value > 0.0) {
            return value;
        }
    }
    return std::nullopt;
}

// Level 5: a chain of elements, each with its length, from byte 128 to the end. libmatio takes a cut one for
// the end of the file.
Status check_whole(const std::string& path) {
    constexpr std::size_t header_bytes = 128;
    std::error_code failure;
    const std::uintmax_t size = std::filesystem::file_size(path, failure);
    std::ifstream file(path, std::ios::binary);
    std::array<char, header_bytes> header{};
    if (failure || !file.read(header.data(), header.size())) { return {}; }
    if (!std::string_view(header.data(), header.size()).starts_with("MATLAB 5.0")) { return {}; }
    const bool swapped = header[126] == 'M';
    for (std::uintmax_t at = header_bytes; at < size;) {
        std::array<unsigned char, 8> tag{};
        file.seekg(static_cast<std::streamoff>(at));
        file.read(reinterpret_cast<char*>(tag.data()), tag.size());
        std::uint32_t bytes = 0;
        for (std::size_t i = 0; i < 4; ++i) { bytes = bytes << 8U | tag[swapped ? 4 + i : 7 - i]; }
        at += tag.size() + bytes;
        if (!file || at > size) {
            return malformed(fmt::format("its last variable ends {} bytes behind the file: it is cut off",
                                         file ? at - size : tag.size()));
        }
    }
    return {};
}

Result<Variables> read_by_libmatio(const std::string& path) {
    const std::unique_ptr<mat_t, CloseReadFile> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
    if (!file) { return malformed("no MAT-file that libmatio can read"); }
    Variables variables;
    const std::size_t most = numbers_most(path);
    while (const ReadVariable variable{Mat_VarReadNextInfo(file.get())}) {
        GYROLOG_CHECK(take(variables, file.get(), *variable, most));
    }
    return variables;
}

// The way from the process that reads: each string and each list after its length. An error is a message
// alone.
class VariablesWriter {
public:
    explicit VariablesWriter(int descriptor) : descriptor_(descriptor) {}

    void write(const Result<Variables>& variables) {
        number(variables.ok() ? 1 : 0);
        if (!variables.ok()) { return text(variables.error().message); }
        number(variables->matrices.size());
        for (const MatMatrix& matrix : variables->matrices) {
            text(matrix.name);
            number(matrix.rows);
            number(matrix.columns);
            bytes(matrix.values.data(), matrix.values.size() * sizeof(double));
        }
        number(variables->scalars.size());
        for (const auto& [name, value] : variables->scalars) {
            text(name);
            bytes(&value, sizeof value);
        }
        text(variables->gyro_axes);
        number(variables->others.size());
        for (const std::string& name : variables->others) { text(name); }
    }

private:
    void number(std::uint64_t value) { bytes(&value, sizeof value); }
    void text(const std::string& value) {
        number(value.size());
        bytes(value.data(), value.size());
    }
    void bytes(const void* data, std::size_t size) {
        const auto* at = static_cast<const char*>(data);
        while (size > 0) {
            const ssize_t written = ::write(descriptor_, at, size);
            if (written <= 0) { return; }
            at += written;
            size -= static_cast<std::size_t>(written);
        }
    }

    int descriptor_;
};

// That process may have been taken over by the file: nothing is believed.
class VariablesReader {
public:
    explicit VariablesReader(ByteView bytes) : left_(bytes) {}

    Result<Variables> read() {
        if (number() != 1) { return malformed(told_reason()); }
        Variables variables;
        for (std::uint64_t n = number(); fine_ && n > 0; --n) {
            MatMatrix matrix{text(), number(), number(), {}};
            fine_ = fine_ && matrix.columns > 0 && matrix.rows <= left_.size() / matrix.columns;
            if (!fine_) { break; }
            matrix.values.resize(matrix.rows * matrix.columns);
            take(matrix.values.data(), matrix.values.size() * sizeof(double));
            variables.matrices.push_back(std::move(matrix));
        }
        for (std::uint64_t n = number(); fine_ && n > 0; --n) {
            std::string name = text();
            double value = 0.0;
            take(&value, sizeof value);
            variables.scalars.emplace_back(std::move(name), value);
        }
        variables.gyro_axes = text();
        for (std::uint64_t n = number(); fine_ && n > 0; --n) { variables.others.push_back(text()); }
        if (!fine_ || !left_.empty()) { return malformed("it is damaged"); }
        return variables;
    }

private:
    std::string told_reason() {
        constexpr std::size_t bytes_most = 400;  // of the reasons that there are
        const std::string reason = text();
        return fine_ && !reason.empty() ? reason.substr(0, bytes_most) : "it is damaged";
    }
    void take(void* data, std::size_t size) {
        fine_ = fine_ && size <= left_.size();
        if (!fine_) { return; }
        if (size > 0) { std::memcpy(data, left_.data(), size); }
        left_ = left_.subspan(size);
    }
    std::uint64_t number() {
        std::uint64_t value = 0;
        take(&value, sizeof value);
        return value;
    }
    std::string text() {
        const std::uint64_t size = number();
        fine_ = fine_ && size <= left_.size();
        std::string value(fine_ ? size : 0, ' ');
        take(value.data(), value.size());
        return value;
    }

    ByteView left_;
    bool fine_ = true;
};

// libmatio and the HDF5 behind it crash on some damaged files, and believe what lengths, dimensions and
// depths a file states.
Result<Bytes> ask_confined_process(const std::string& path) {
    GYROLOG_CHECK(check_whole(path));
    std::error_code unknown;
    const std::uintmax_t file_bytes = std::filesystem::file_size(path, unknown);
    const std::size_t number_bytes = numbers_most(path) * sizeof(double);
    const double s_for_bytes =
        unknown ? 0.0 : input_limits.mat_read_s_per_byte * static_cast<double>(file_bytes);
    const ProcessConfines confines{input_limits.mat_library_bytes_most + 4 * number_bytes,
                                   input_limits.mat_read_s_least + s_for_bytes,
                                   input_limits.mat_library_bytes_most + number_bytes};
    return run_confined(confines, [&](int descriptor) { tell_mat_file(path, descriptor); });
}

Result<Recording> read_mat_file(const std::string& path, const RecordingReadOptions& options) {
    GYROLOG_TRY(const Bytes told, ask_confined_process(path));
    return recording_of_mat_answer(told, path, options);
}

}  // namespace

void tell_mat_file(const std::string& path, int descriptor) {
    VariablesWriter(descriptor).write(read_by_libmatio(path));
}

Result<Recording> recording_of_mat_answer(ByteView told, const std::string& path,
                                          RecordingReadOptions options) {
    GYROLOG_TRY(Variables variables, VariablesReader(told).read());
    std::vector<NumberColumn> columns = columns_of(variables.matrices, variables.gyro_axes);
    GYROLOG_CHECK(keep_samples(columns));
    if (columns.empty()) {
        return malformed(variables.others.empty()
                             ? "it holds no variable of numbers"
                             : "it holds no matrix of numbers, but " + some_names(variables.others) +
                                   ": save vectors, such as omega and Fs");
    }
    const bool has_time = std::ranges::any_of(columns, names_time, &NumberColumn::header);
    if (!options.rate_hz && !has_time) { options.rate_hz = rate_of(variables); }
    return recording_of_numbers(std::move(columns), path.substr(path.find_last_of('/') + 1), options);
}

Result<Recording> read_recording_mat(const std::string& path, const RecordingReadOptions& options) {
    Result<Recording> recording = read_mat_file(path, options);
    if (!recording.ok()) { return in_context("read '" + path + "'", std::move(recording).error()); }
    return recording;
}

}  // namespace gyrolog
