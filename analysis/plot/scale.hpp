// An axis's scale: where a value lies, and which values to mark.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gyrolog {

enum class ScaleKind { linear, logarithmic };

struct Range {
    double lo = 0.0;
    double hi = 1.0;
};

// Whether a range is one to draw: finite, rising, far enough apart for doubles to count ticks in, and above
// zero on a logarithmic scale. What RangeFinder gives always is.
bool can_scale(ScaleKind kind, Range range);

// The map between values and pixels. On a vertical axis pixel_lo is the larger of the two.
struct Scale {
    ScaleKind kind = ScaleKind::linear;
    Range range;
    double pixel_lo = 0.0;
    double pixel_hi = 1.0;

    double pixel(
        double value) const;  // NaN where the scale cannot show the value: not finite, or log of <= 0
    double value(double pixel) const;
};

struct Tick {
    double value = 0.0;
    std::string label;  // empty: a minor tick
};

struct Ticks {
    std::vector<Tick> ticks;  // rising
    int exponent = 0;         // labels are to be read times 10^exponent; 0 on a logarithmic scale
};

// At most max_labels labels, max_labels >= 2. Linear: steps of 1, 2 or 5 times a power of ten.
// Logarithmic: powers of ten with 2 to 9 between; every 2nd, 3rd, 5th, ... power where there are too many;
// where there are fewer than three, also 2 and 5; where those are too few as well, linear steps.
Ticks find_ticks(ScaleKind kind, Range range, int max_labels);

// The finest ticks whose labels keep apart by min_apart_px, given each label's extent along the axis.
Ticks fit_ticks(const Scale& scale, double min_apart_px,
                const std::function<double(const std::string&)>& extent_px);

// Collects what an axis must show and says the range to draw.
class RangeFinder {
public:
    explicit RangeFinder(ScaleKind kind) : kind_(kind) {}
    void add(double value);  // ignores what the scale cannot show
    bool empty() const { return !found_; }

    // The values with a margin on both sides (a share of the length in the scale's own measure). A
    // logarithmic range is at least min_decades long, and a linear one is never empty. Nothing added: 0 to 1
    // or 1 to 10.
    Range padded(double margin_share, double min_decades) const;

private:
    ScaleKind kind_;
    std::optional<Range> found_;
};

}  // namespace gyrolog
