// What the process that reads a .mat tells is believed in nothing: any bytes of it become a recording that
// keeps its promises, or an error. And MAT-files of level 5 whose lengths agree, made from the bytes, are
// read here as that process reads them. Files that libmatio itself crashes on are its process's affair.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/capture/byte_order.hpp"
#include "host/formats/recording_mat_read.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/recording_promises.hpp"

namespace {

using namespace gyrolog;

void understand(ByteView told, const RecordingReadOptions& options) {
    const auto recording = recording_of_mat_answer(told, "fuzz.mat", options);
    if (recording.ok()) {
        check_promises(*recording);
    } else {
        GYROLOG_REQUIRE(!recording.error().message.empty());
    }
}

// Bytes of the input, one behind the other; zeros behind its end.
class Choices {
public:
    explicit Choices(ByteView bytes) : left_(bytes) {}
    bool any() const { return !left_.empty(); }
    std::uint8_t next() {
        if (left_.empty()) { return 0; }
        const std::uint8_t byte = left_.front();
        left_ = left_.subspan(1);
        return byte;
    }

private:
    ByteView left_;
};

// An element of the file: its tag, its data, and zeros up to a multiple of eight.
void append_element(Bytes& out, std::uint32_t type, const Bytes& data) {
    put<std::uint32_t>(out, type);
    put<std::uint32_t>(out, static_cast<std::uint32_t>(data.size()));
    out.insert(out.end(), data.begin(), data.end());
    out.resize((out.size() + 7) / 8 * 8);
}

constexpr std::array names{"gyro", "gyro_axes",        "t",   "omega", "Fs", "gx_dps",
                           "gy",   "temperature_degC", "acc", "x"};

struct NumberType {
    std::uint8_t array_class;  // mxDOUBLE_CLASS and so on
    std::uint32_t type;        // miDOUBLE and so on
    std::size_t bytes;
};
constexpr std::array number_types{NumberType{6, 9, 8},  NumberType{7, 7, 4},  NumberType{8, 1, 1},
                                  NumberType{10, 3, 2}, NumberType{13, 6, 4}, NumberType{4, 4, 2}};

void append_matrix(Bytes& file, Choices& choices) {
    const NumberType& kind = number_types.at(choices.next() % number_types.size());
    const std::uint32_t rows = choices.next() % 40U;
    const std::uint32_t columns = choices.next() % 5U;
    std::string name = names.at(choices.next() % names.size());
    if (choices.next() % 8U == 0) { name.assign(choices.next() % 100U, static_cast<char>(choices.next())); }
    Bytes flags;
    put<std::uint32_t>(flags, kind.array_class);
    put<std::uint32_t>(flags, 0);
    Bytes sizes;
    put<std::uint32_t>(sizes, rows);
    put<std::uint32_t>(sizes, columns);
    Bytes numbers(std::size_t{rows} * columns * kind.bytes);
    std::ranges::generate(numbers, [&] { return choices.next(); });
    Bytes matrix;
    append_element(matrix, 6, flags);
    append_element(matrix, 5, sizes);
    append_element(matrix, 1, Bytes(name.begin(), name.end()));
    append_element(matrix, kind.type, numbers);
    append_element(file, 14, matrix);
}

Bytes mat_file(ByteView bytes) {
    constexpr std::size_t text_bytes = 124;
    const std::string_view head = "MATLAB 5.0 MAT-file";
    Bytes file(head.begin(), head.end());
    file.resize(text_bytes, ' ');
    put<std::uint16_t>(file, 0x0100);
    file.push_back('I');
    file.push_back('M');
    Choices choices(bytes);
    while (choices.any()) { append_matrix(file, choices); }
    return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const ByteView bytes(data, size);
    RecordingReadOptions options;
    understand(bytes, options);
    options.choice = {.columns = {}, .gyro_unit = "rad/s"};
    const MemoryFile file(mat_file(bytes));
    const MemoryFile answer;
    tell_mat_file(file.path(), answer.descriptor());
    understand(answer.contents(), options);
    return 0;
}
