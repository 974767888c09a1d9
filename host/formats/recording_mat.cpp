#include "host/formats/recording_mat.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <matio.h>
#include <unistd.h>

#include "host/base/replacing_file.hpp"

namespace gyrolog {
namespace {

struct CloseFile {
    void operator()(mat_t* file) const { Mat_Close(file); }
};
using MatFile = std::unique_ptr<mat_t, CloseFile>;

struct FreeVariable {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

constexpr std::size_t level_5_bytes_max = (std::size_t{1} << 31) - 1;

// matio copies the data, and only reads what it is given.
void* unconst(const void* data) {
    return const_cast<void*>(data);
}  // NOLINT(cppcoreguidelines-pro-type-const-cast)

Variable matrix(const char* name, const std::vector<double>& values, std::size_t columns = 1) {
    std::array<std::size_t, 2> size = {values.size() / columns, columns};
    return Variable(
        Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, size.size(), size.data(), unconst(values.data()), 0));
}

Variable scalar(const char* name, double value) { return matrix(name, {value}); }

Variable text(const char* name, const std::string& value) {
    std::array<std::size_t, 2> size = {1, value.size()};
    return Variable(
        Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF8, size.size(), size.data(), unconst(value.data()), 0));
}

// A 1x1 structure that takes over its fields.
class Structure {
public:
    explicit Structure(const char* name) {
        std::array<std::size_t, 2> size = {1, 1};
        variable_.reset(Mat_VarCreateStruct(name, size.size(), size.data(), nullptr, 0));
    }
    void add(const char* field, Variable value) {
        Mat_VarAddStructField(variable_.get(), field);
        Mat_VarSetStructFieldByName(variable_.get(), field, 0, value.release());
    }
    Variable take() { return std::move(variable_); }

private:
    Variable variable_;
};

Variable coefficient(const char* name, const FittedCoefficient& fitted) {
    const bool identified = fitted.state == FittedCoefficient::State::identified;
    Structure structure(name);
    structure.add("identified", scalar("identified", identified ? 1.0 : 0.0));
    const auto add_if = [&](bool present, const char* field, double value) {
        structure.add(field, present ? scalar(field, value) : matrix(field, {}));
    };
    add_if(identified, "value", fitted.value);
    add_if(identified, "sd", fitted.sd);
    add_if(identified, "lo", fitted.lo);
    add_if(identified, "hi", fitted.hi);
    add_if(true, "upper", fitted.upper);
    add_if(true, "estimate", fitted.estimate);
    add_if(true, "estimate_sd", fitted.estimate_sd);
    return structure.take();
}

Variable axis_of(const AxisReport& axis) {
    Structure structure(axis.axis.c_str());
    structure.add("bias", scalar("bias", axis.bias.value));
    structure.add("bias_expanded_uncertainty",
                  scalar("bias_expanded_uncertainty", axis.bias.expanded_uncertainty));
    const auto add_points = [&](const char* field, double AllanPoint::*member) {
        std::vector<double> values;
        for (const AllanPoint& point : axis.curve.points) { values.push_back(point.*member); }
        structure.add(field, matrix(field, values));
    };
    add_points("tau", &AllanPoint::tau_s);
    add_points("adev", &AllanPoint::deviation);
    add_points("adev_lo", &AllanPoint::lo);
    add_points("adev_hi", &AllanPoint::hi);
    add_points("edf", &AllanPoint::edf);
    for (const NoiseTerm term : all_noise_terms) {
        const std::string name(name_of(term));
        structure.add(name.c_str(), coefficient(name.c_str(), axis.fit[term]));
    }
    return structure.take();
}

std::vector<double> times_of(const Recording& recording) {
    if (!recording.t_s.empty()) { return recording.t_s; }
    std::vector<double> t_s;
    t_s.reserve(recording.rows());
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            t_s.push_back(static_cast<double>(segment.first_index + static_cast<std::int64_t>(i)) /
                          recording.rate_hz);
        }
    }
    return t_s;
}

bool is_gyro(const Column& column) { return column.name.size() >= 2 && column.name[0] == 'g'; }

// The first error is kept; what follows is not written.
class MatWriter {
public:
    explicit MatWriter(mat_t* file) : file_(file) {}

    void write(Variable variable, std::size_t bytes = 0) {
        if (!failure_.empty()) { return; }
        if (bytes > level_5_bytes_max) {
            failure_ =
                std::string(variable->name) + " has more than the 2 GB that a MAT-file of level 5 can hold";
        } else if (Mat_VarWrite(file_, variable.get(), MAT_COMPRESSION_ZLIB) != 0) {
            failure_ = "writing failed; is the disk full?";
        } else {
            ++written_;
        }
    }
    const std::string& failure() const { return failure_; }
    std::size_t written() const { return written_; }

private:
    mat_t* file_;
    std::string failure_;
    std::size_t written_ = 0;
};

void write_columns(MatWriter& writer, const Recording& recording) {
    std::vector<double> gyro;
    std::string axes;
    std::size_t gyros = 0;
    for (const Column& column : recording.columns) {
        if (!is_gyro(column)) { continue; }
        const std::vector<double> values = column.values();
        gyro.insert(gyro.end(), values.begin(), values.end());
        if (!axes.empty()) { axes += ' '; }
        axes += column.name.substr(1);
        ++gyros;
    }
    if (gyros > 0) { writer.write(matrix("gyro", gyro, gyros), gyro.size() * sizeof(double)); }
    writer.write(text("gyro_axes", axes));
    for (const Column& column : recording.columns) {
        if (is_gyro(column)) { continue; }
        const std::string name = column.unit == "degC" ? "temperature_degC" : column.name;
        writer.write(matrix(name.c_str(), column.values()), column.size() * sizeof(double));
    }
}

std::string write_all(mat_t* file, const ExportSource& source, std::size_t& written) {
    MatWriter writer(file);
    writer.write(text("source", source.name));
    writer.write(scalar("rate_hz", source.rate_hz));
    if (const auto warnings = warnings_of(source); !warnings.empty()) {
        writer.write(text("warnings", fmt::format("{}", fmt::join(warnings, "\n"))));
    }
    const std::vector<double> t_s = times_of(*source.recording);
    writer.write(matrix("t", t_s), t_s.size() * sizeof(double));
    write_columns(writer, *source.recording);
    Structure analysis("analysis");
    for (const AxisReport& axis : source.report->axes) { analysis.add(axis.axis.c_str(), axis_of(axis)); }
    if (source.report->accelerometer) {
        Structure accelerometer("accelerometer");
        for (const AxisReport& axis : source.report->accelerometer->axes) {
            accelerometer.add(axis.axis.c_str(), axis_of(axis));
        }
        analysis.add("accelerometer", accelerometer.take());
    }
    writer.write(analysis.take());
    written = writer.written();
    return writer.failure();
}

// matio does not tell a write that the disk refused: what is in the file is counted.
std::size_t variables_in(const std::string& path) {
    const MatFile file(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
    std::size_t count = 0;
    while (file && Variable(Mat_VarReadNext(file.get()))) { ++count; }
    return count;
}

// matio hardly ever tells why it fails: a disk that takes no more bytes of ours took none of its either.
Error why_failed(ReplacingFile& file, std::string failure) {
    constexpr std::array<std::uint8_t, 65536> more{};
    static_cast<void>(::lseek(file.descriptor(), 0, SEEK_END));
    const Status room = file.write(more);
    return room.ok() ? Error{ErrorCode::failed, std::move(failure)} : room.error();
}

Status replace_mat(const ExportSource& source, const std::string& path) {
    GYROLOG_TRY(ReplacingFile file, ReplacingFile::create(path));
    std::size_t written = 0;
    std::string failure;
    {
        const MatFile mat(Mat_CreateVer(file.written_path().c_str(),
                                        "MATLAB 5.0 MAT-file, written by gyrolog", MAT_FT_MAT5));
        failure = mat ? write_all(mat.get(), source, written) : "the file cannot be created";
    }
    if (failure.empty() && variables_in(file.written_path()) != written) {
        failure = "what was written cannot be read back";
    }
    return failure.empty() ? file.commit() : why_failed(file, std::move(failure));
}

}  // namespace

Status write_recording_mat(const ExportSource& source, const std::string& path) {
    const Status done = replace_mat(source, path);
    return done.ok() ? done : in_context("write '" + path + "'", done.error());
}

}  // namespace gyrolog
