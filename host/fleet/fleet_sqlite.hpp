// The table of recordings as an SQLite database.
#pragma once

#include <string>

#include "host/base/result.hpp"
#include "host/fleet/fleet_table.hpp"

namespace gyrolog {

// One table `recordings` with the columns of `table`; what is not known is NULL. Replaces the file at `path`
// once the database is whole. Errors: those of write_file(); `invalid_argument` where `path` is no file,
// which a database needs.
Status write_sqlite(const FleetTable& table, const std::string& path);

}  // namespace gyrolog
