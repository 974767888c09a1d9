#include "analysis/plot/typeface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

namespace gyrolog {
namespace {

constexpr char32_t replacement = U'\uFFFD';
constexpr double px_of_26_6 = 1.0 / 64.0;
constexpr double px_of_16_16 = 1.0 / 65536.0;

// Length of the sequence this byte begins; 0 when it begins none.
std::size_t sequence_bytes(unsigned char first) {
    if (first < 0x80U) { return 1; }
    if (first >= 0xC2U && first < 0xE0U) { return 2; }
    if (first >= 0xE0U && first < 0xF0U) { return 3; }
    if (first >= 0xF0U && first < 0xF5U) { return 4; }
    return 0;
}

// The character at the front of the text, and how many bytes it took.
std::pair<char32_t, std::size_t> first_character(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    const std::size_t bytes = sequence_bytes(first);
    if (bytes == 0 || bytes > text.size()) { return {replacement, 1}; }
    if (bytes == 1) { return {first < 0x20U || first == 0x7FU ? replacement : char32_t{first}, 1}; }
    char32_t character = first & (0xFFU >> (bytes + 1));
    for (std::size_t i = 1; i < bytes; ++i) {
        const auto next = static_cast<unsigned char>(text[i]);
        if ((next & 0xC0U) != 0x80U) { return {replacement, 1}; }
        character = (character << 6U) | (next & 0x3FU);
    }
    const bool overlong = (bytes == 3 && character < 0x800) || (bytes == 4 && character < 0x10000);
    const bool surrogate = character >= 0xD800 && character < 0xE000;
    const bool control = character < 0xA0;
    return {overlong || surrogate || control || character > 0x10FFFF ? replacement : character, bytes};
}

}  // namespace

struct Typeface::Face {
    FT_Library library = nullptr;
    FT_Face face = nullptr;

    Face() = default;
    Face(const Face&) = delete;
    Face& operator=(const Face&) = delete;
    ~Face() {
        if (face != nullptr) { FT_Done_Face(face); }
        if (library != nullptr) { FT_Done_FreeType(library); }
    }

    void set_size(double size_px) const {
        FT_Set_Char_Size(face, 0, static_cast<FT_F26Dot6>(std::lround(size_px / px_of_26_6)), 72, 72);
    }

    // Calls visit(pen_x_px, character) with each glyph loaded into the face's slot in turn; returns the pen's
    // end.
    template <typename Visit>
    double walk(std::string_view text, double size_px, double start_px, Visit visit) const {
        set_size(size_px);
        double pen_px = start_px;
        FT_UInt previous = 0;
        for (const char32_t character : decode_utf8(text)) {
            const FT_UInt glyph = FT_Get_Char_Index(face, character);
            FT_Vector kerning{};
            if (previous != 0 && glyph != 0 &&
                FT_Get_Kerning(face, previous, glyph, FT_KERNING_UNFITTED, &kerning) == 0) {
                pen_px += static_cast<double>(kerning.x) * px_of_26_6;
            }
            previous = glyph;
            if (FT_Load_Glyph(face, glyph, FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP) != 0) { continue; }
            visit(pen_px, character);
            pen_px += static_cast<double>(face->glyph->linearHoriAdvance) * px_of_16_16;
        }
        return pen_px;
    }
};

namespace {

struct PlacedGlyph {
    int left_px, top_px, width_px, height_px;
    std::vector<std::uint8_t> coverage;
};

PlacedGlyph rasterised(FT_GlyphSlot slot, double pen_px) {
    const double whole_px = std::floor(pen_px);
    FT_Outline_Translate(&slot->outline, static_cast<FT_Pos>(std::lround((pen_px - whole_px) / px_of_26_6)),
                         0);
    if (FT_Render_Glyph(slot, FT_RENDER_MODE_NORMAL) != 0) { return {}; }
    const FT_Bitmap& bitmap = slot->bitmap;
    PlacedGlyph glyph{static_cast<int>(whole_px) + slot->bitmap_left,
                      -slot->bitmap_top,
                      static_cast<int>(bitmap.width),
                      static_cast<int>(bitmap.rows),
                      {}};
    for (unsigned row = 0; row < bitmap.rows; ++row) {
        const unsigned char* line = bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch;
        glyph.coverage.insert(glyph.coverage.end(), line, line + bitmap.width);
    }
    return glyph;
}

}  // namespace

std::optional<Typeface> Typeface::open(const std::string& path, std::string& problem) {
    auto face = std::make_shared<Face>();
    if (FT_Init_FreeType(&face->library) != 0) {
        problem = "start FreeType: out of memory";
        return std::nullopt;
    }
    if (FT_New_Face(face->library, path.c_str(), 0, &face->face) != 0) {
        face->face = nullptr;
        problem = "open font '" + path + "': not found or not a font; install fonts-dejavu-core";
        return std::nullopt;
    }
    return Typeface(std::move(face));
}

TextExtent Typeface::measure(std::string_view text, double size_px) const {
    TextExtent extent;
    FT_GlyphSlot slot = face_->face->glyph;
    extent.width_px = face_->walk(text, size_px, 0.0, [&](double, char32_t) {
        FT_BBox ink{};
        FT_Outline_Get_CBox(&slot->outline, &ink);
        extent.ascent_px = std::max(extent.ascent_px, static_cast<double>(ink.yMax) * px_of_26_6);
        extent.descent_px = std::max(extent.descent_px, static_cast<double>(-ink.yMin) * px_of_26_6);
    });
    return extent;
}

TextMask Typeface::render(std::string_view text, double size_px, double start_fraction_px) const {
    std::vector<PlacedGlyph> glyphs;
    FT_GlyphSlot slot = face_->face->glyph;
    face_->walk(text, size_px, start_fraction_px, [&](double pen_px, char32_t) {
        PlacedGlyph glyph = rasterised(slot, pen_px);
        if (!glyph.coverage.empty()) { glyphs.push_back(std::move(glyph)); }
    });
    if (glyphs.empty()) { return {}; }

    int left = glyphs[0].left_px, top = glyphs[0].top_px, right = left, bottom = top;
    for (const PlacedGlyph& glyph : glyphs) {
        left = std::min(left, glyph.left_px);
        top = std::min(top, glyph.top_px);
        right = std::max(right, glyph.left_px + glyph.width_px);
        bottom = std::max(bottom, glyph.top_px + glyph.height_px);
    }
    TextMask mask{right - left, bottom - top, left, top, {}};
    const auto width = static_cast<std::size_t>(mask.width_px);
    mask.coverage.resize(width * static_cast<std::size_t>(mask.height_px));
    for (const PlacedGlyph& glyph : glyphs) {
        const auto columns = static_cast<std::size_t>(glyph.width_px);
        for (std::size_t row = 0; row < static_cast<std::size_t>(glyph.height_px); ++row) {
            const std::size_t at = (static_cast<std::size_t>(glyph.top_px - top) + row) * width +
                                   static_cast<std::size_t>(glyph.left_px - left);
            for (std::size_t column = 0; column < columns; ++column) {
                std::uint8_t& pixel = mask.coverage[at + column];
                pixel = std::max(pixel, glyph.coverage[row * columns + column]);
            }
        }
    }
    return mask;
}

TextMask TextMask::turned_left() const {
    TextMask turned{height_px, width_px, top_px, -(left_px + width_px), {}};
    turned.coverage.resize(coverage.size());
    const auto columns = static_cast<std::size_t>(width_px);
    const auto rows = static_cast<std::size_t>(height_px);
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            turned.coverage[(columns - 1 - column) * rows + row] = coverage[row * columns + column];
        }
    }
    return turned;
}

std::vector<PositionedGlyph> Typeface::glyphs(std::string_view text, double size_px) const {
    std::vector<PositionedGlyph> glyphs;
    face_->walk(text, size_px, 0.0, [&](double pen_px, char32_t character) {
        glyphs.push_back({character, FT_Get_Char_Index(face_->face, character), pen_px});
    });
    return glyphs;
}

FT_FaceRec_* Typeface::freetype_face() const { return face_->face; }

std::shared_ptr<const void> Typeface::owner() const { return face_; }

double Typeface::cap_height_px(double size_px) const { return measure("H", size_px).ascent_px; }

bool Typeface::has(char32_t character) const { return FT_Get_Char_Index(face_->face, character) != 0; }

std::string Typeface::shortened(std::string_view text, double size_px, double width_px,
                                Ellipsis where) const {
    const auto fits = [&](const std::string& candidate) {
        return measure(candidate, size_px).width_px <= width_px;
    };
    const std::u32string characters = decode_utf8(text);
    if (fits(std::string(text))) { return std::string(text); }

    const auto keeping = [&](std::size_t kept) {
        const std::size_t tail = where == Ellipsis::middle ? kept / 2 : 0;
        return encode_utf8(characters.substr(0, kept - tail)) + "…" +
               encode_utf8(characters.substr(characters.size() - tail));
    };
    // Fewest that do not fit, by bisection: width grows with the number of characters kept but for kerning.
    std::size_t fitting = 0;
    std::size_t too_many = characters.size();
    while (too_many - fitting > 1) {
        const std::size_t middle = (fitting + too_many) / 2;
        (fits(keeping(middle)) ? fitting : too_many) = middle;
    }
    const std::string best = keeping(fitting);
    return fits(best) ? best : std::string();
}

std::u32string decode_utf8(std::string_view text) {
    std::u32string characters;
    while (!text.empty()) {
        const auto [character, bytes] = first_character(text);
        characters.push_back(character);
        text.remove_prefix(bytes);
    }
    return characters;
}

std::string encode_utf8(std::u32string_view text) {
    std::string bytes;
    const auto put = [&bytes](char32_t value) { bytes.push_back(static_cast<char>(value)); };
    for (const char32_t c : text) {
        if (c < 0x80) {
            put(c);
        } else if (c < 0x800) {
            put(0xC0U | (c >> 6U));
            put(0x80U | (c & 0x3FU));
        } else if (c < 0x10000) {
            put(0xE0U | (c >> 12U));
            put(0x80U | ((c >> 6U) & 0x3FU));
            put(0x80U | (c & 0x3FU));
        } else {
            put(0xF0U | (c >> 18U));
            put(0x80U | ((c >> 12U) & 0x3FU));
            put(0x80U | ((c >> 6U) & 0x3FU));
            put(0x80U | (c & 0x3FU));
        }
    }
    return bytes;
}

}  // namespace gyrolog
