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
    "Scale of gyro columns that are counts (_lsb), in deg/s per count: 0.015267 where a data sheet says "
    "65.5 LSB per deg/s";

}  // namespace gyrolog
