// Text as masks of coverage: UTF-8 in, kerned, placed to a fraction of a pixel, light (vertical only)
// hinting.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct FT_FaceRec_;

namespace gyrolog {

struct TextExtent {
    double width_px = 0.0;    // advance of the whole line
    double ascent_px = 0.0;   // ink above the baseline
    double descent_px = 0.0;  // ink below the baseline
};

struct TextMask {
    int width_px = 0;
    int height_px = 0;
    int left_px = 0;                     // of the mask's first column, from the pen's start
    int top_px = 0;                      // of the mask's first row, from the baseline; negative is above
    std::vector<std::uint8_t> coverage;  // 0..255, row by row

    TextMask turned_left() const;  // a quarter turn against the clock, reading upwards
};

struct PositionedGlyph {
    char32_t character = 0;
    unsigned index = 0;  // in the font
    double x_px = 0.0;   // of the pen, from where the text begins
};

enum class Ellipsis { middle, end };

class Typeface {
public:
    // Fonts of Debian's fonts-dejavu-core. On failure there is no value and `problem` names the file and the
    // mend.
    static constexpr std::string_view debian_directory = "/usr/share/fonts/truetype/dejavu";
    static std::optional<Typeface> open(const std::string& path, std::string& problem);

    TextExtent measure(std::string_view text, double size_px) const;

    // start_fraction_px in [0, 1): the pen starts that far right of the mask's origin.
    TextMask render(std::string_view text, double size_px, double start_fraction_px = 0.0) const;

    // For those who draw the letters themselves. The face is the owner's.
    std::vector<PositionedGlyph> glyphs(std::string_view text, double size_px) const;
    FT_FaceRec_* freetype_face() const;
    std::shared_ptr<const void> owner() const;

    // Height of a capital letter or a digit: what to centre a line of text by.
    double cap_height_px(double size_px) const;

    bool has(char32_t character) const;

    // The text, or its beginning (and end) with an ellipsis, so that it is no wider than width_px. Empty when
    // not even the ellipsis fits.
    std::string shortened(std::string_view text, double size_px, double width_px, Ellipsis where) const;

private:
    struct Face;
    explicit Typeface(std::shared_ptr<Face> face) : face_(std::move(face)) {}
    std::shared_ptr<Face> face_;
};

// Bytes that are no UTF-8, and control characters, come out as U+FFFD.
std::u32string decode_utf8(std::string_view text);
std::string encode_utf8(std::u32string_view text);

}  // namespace gyrolog
