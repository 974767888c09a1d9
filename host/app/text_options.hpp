// Options that say what the columns of a RECORDING are where its names do not, for every command that reads
// one.
#pragma once

#include <CLI/CLI.hpp>

#include "host/formats/understood_columns.hpp"

namespace gyrolog {

using TextChoice = ColumnChoice;

// --columns, --unit, --acc-unit.
void add_text_options(CLI::App& app, TextChoice& choice);

inline constexpr const char* lsb_dps_help =
    "Scale of gyro columns that are counts (_lsb), in deg/s per count: for a data sheet's 65.5 LSB per deg/s "
    "it "
    "is 1/65.5 = 0.015267";

}  // namespace gyrolog
