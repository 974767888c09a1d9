// How much a file that is read may ask for. What is beyond is no recording, curve or model that anyone made,
// and is refused in time and memory that do not depend on it.
#pragma once

#include <cstddef>

namespace gyrolog {

struct InputLimits {
    // Of text, without its line break. A thousand gyros with three axes of 25 digits take 75 kB.
    std::size_t line_bytes_most = std::size_t{1} << 20;
    // What a compressed file may unpack to, in its own size, beyond what is free. Measured: text of noise 3,
    // counts at rest with time stamps 34 (xz), without stamps 135 (bz2).
    std::size_t unpacked_ratio_most = 200;
    std::size_t unpacked_free_bytes = std::size_t{64} << 20;
    // Of text: a thousand gyros with three axes, a temperature and a stamp each are 5000.
    std::size_t columns_most = 10'000;
    // Of the header of an .npy: a thousand names in a structured type take 30 kB.
    std::size_t npy_header_bytes_most = std::size_t{1} << 20;
    // Of numbers in an .npy or in one variable of a .mat: a day of four columns at 8 kHz is 2.8 billion.
    std::size_t numbers_most = std::size_t{1} << 32;
    // Of a name in a .mat: MATLAB's namelengthmax.
    std::size_t mat_name_bytes_most = 63;
    // What libmatio and HDF5 need beside the numbers of a .mat, and the processor time that reading may take,
    // in s, and in s for each byte of the file. Guessed, far above what a recording takes (tests read within
    // 0.1 s): they bound a file made to harm.
    std::size_t mat_library_bytes_most = std::size_t{256} << 20;
    double mat_read_s_least = 10.0;
    double mat_read_s_per_byte = 2e-7;
    // Of a model: one with 33 effects on three axes and all their uncertainties takes 200 kB and 3000 keys.
    std::size_t json_bytes_most = std::size_t{16} << 20;
    std::size_t json_keys_most = 10'000;
    int json_nesting_most = 32;
    // Of a simulator's file: a world with a thousand robots of a hundred links takes some 10 MB, as many
    // bytes as a model may have, and less than so many elements. Of the YAML of a sensor, which its library
    // reads in a hundredfold of its size, that of many cameras is 100 kB.
    std::size_t xml_elements_most = 1'000'000;
    int xml_nesting_most = 256;
    std::size_t xml_sensors_most = 1000;
    std::size_t yaml_bytes_most = std::size_t{1} << 18;
    int yaml_nesting_most = 32;
    // Of a line of results: one of json_bytes_most that holds nothing but points of an Allan deviation has so
    // many.
    std::size_t json_line_keys_most = 700'000;
};

inline constexpr InputLimits input_limits;

}  // namespace gyrolog
