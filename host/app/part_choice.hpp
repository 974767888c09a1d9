// The part of a recording that a command looks at.
#pragma once

#include <optional>
#include <string>

#include "analysis/recording/recording_part.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

struct PartChoice {
    std::optional<double> from_s{};  // from the first sampling instant
    std::optional<double> to_s{};
    bool is_still = false;  // of that, the longest part in which nothing turns

    bool is_whole() const { return !from_s && !to_s && !is_still; }
};

// The times that are meant. Errors: fewer than two samples there; nothing rests for long enough
// (still_part_of()).
Result<TimeSpan> chosen_span(const Recording& recording, const PartChoice& choice, const std::string& path);

// The part as part_of() has it, with a warning that says which it is; the recording where it is whole.
Result<Recording> take_part(Recording recording, const PartChoice& choice, const std::string& path);

}  // namespace gyrolog
