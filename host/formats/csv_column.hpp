// What a column of a recording in text means, read from its name: the quantity, its axis, and the unit after
// it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace gyrolog {

struct CsvColumn {
    enum class Kind {
        time_stamp,       // t_s, t_ms, t_us, t_ns
        rate,             // gx_dps, gx_rad_s, gx_deg_h, gx_mdps, gx_lsb, gx2_dps
        angle,            // gx_deg, gx_rad: the integrated rate
        angle_increment,  // dgx_deg, dgx_rad: since the sample before
        force,            // ax_g, ax_m_s2, ax_mg, ax_lsb
        temperature,      // temp_C
        reference,        // ref_x_dps, ref_x_rad_s, ref_qw
        stop,             // stopped_s: how long the user had stopped the board before the sample, mostly 0
    };
    Kind kind = Kind::time_stamp;
    std::string name;         // as in Column
    std::string unit;         // of the column in SI; a rate's for angles and increments, too
    std::string source_unit;  // as in Column; "dps" for angles in degrees
    double scale = 1.0;  // SI per number; 1 for counts, whose scale the name does not tell, and for stamps
    double per_s = 1.0;  // of stamps: numbers per second

    bool is_gyro() const {
        return kind == Kind::rate || kind == Kind::angle || kind == Kind::angle_increment;
    }
    bool is_counts() const { return source_unit == "lsb"; }
};

inline constexpr std::string_view stopped_column = "stopped_s";

// Nothing for a name that is neither one of those above nor stopped_column: what other programs call their
// columns is for column_dialect.hpp.
std::optional<CsvColumn> csv_column(std::string_view header);

}  // namespace gyrolog
