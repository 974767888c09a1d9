// Recordings as an array of gyros: which columns are units of one axis, and several recordings of the same
// time as one.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct ArrayAxis {
    std::string name;                     // "x"
    std::vector<const Column*> units;     // "gx1", "gx2", ... by number; or "gx" alone
    std::vector<std::string> unit_names;  // "1", "2", ...; "" of a single gyro
};

// In the order x, y, z, of the axes that the recording has. Points into it.
std::vector<ArrayAxis> array_axes(const Recording& recording);

// A recording on its way into an array: `start_s` is the time of its grid's index 0 on a clock that all
// share.
struct ArrayMember {
    const Recording* recording;
    double start_s = 0.0;
};

struct JoinedArray {
    Recording recording;
    std::string failure;  // why they make no array; empty when they do
};

// The first member's rows, stamps and other columns; each gyro column becomes a numbered one, gx1 gx2 ..., in
// the members' order. From the others comes the sample nearest in time, at most half a period away: nothing
// is interpolated, so that the noise stays what it was. Where a member has none the value is NaN. Rates may
// differ by a percent; a warning says how many samples were left out or taken twice for it.
JoinedArray join_recordings(std::span<const ArrayMember> members);

// Parts of the segments in which all columns are known.
std::vector<Segment> segments_known(std::span<const Column* const> columns,
                                    std::span<const Segment> segments);

// The rows of these segments, which lie within the recording's, and these columns alone.
Recording rows_of(const Recording& recording, std::span<const Column* const> columns,
                  std::span<const Segment> segments);

}  // namespace gyrolog
