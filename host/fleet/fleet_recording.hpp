// What all lines together say of each recording.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/fleet/fleet_line.hpp"

namespace gyrolog {

struct FleetRecordings {
    std::vector<FleetLine> recordings;    // one each, in the order in which they came first
    std::vector<std::string> unanswered;  // of those that were expected; they stand among the recordings
};

// Lines of one file are joined, also where its name is written in two ways ("./a.csv"). Of one command the
// last line counts: what was done again. What more than one command says is taken from analyze, then check,
// diagnose, compare; axes are joined by their names, errors stand behind each other, seconds are summed, and
// the exit code is `worst` of all.
//
// `expected` that have no line become recordings with the error "no answer". A name without a folder stands
// for the file of that name in any.
FleetRecordings join_lines(std::span<const FleetLine> lines, std::span<const std::string> expected,
                           int (*worst)(int, int));

}  // namespace gyrolog
