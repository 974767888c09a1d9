#include "analysis/plot/vector_file.hpp"

#include <cstddef>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <cairo-svg.h>

#include "analysis/plot/paper_size.hpp"

namespace gyrolog {
namespace {

constexpr double of_255 = 1.0 / 255.0;

double points_per_pixel(const Drawing& drawing) { return points_per_inch / drawing.dpi; }

using File = std::vector<std::uint8_t>;

template <auto destroy>
struct Destroy {
    template <typename Thing>
    void operator()(Thing* thing) const {
        destroy(thing);
    }
};
using Surface = std::unique_ptr<cairo_surface_t, Destroy<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Destroy<cairo_destroy>>;
using FontFace = std::unique_ptr<cairo_font_face_t, Destroy<cairo_font_face_destroy>>;

cairo_status_t append(void* file, const unsigned char* bytes, unsigned size) {
    auto& to = *static_cast<File*>(file);
    to.insert(to.end(), bytes, bytes + size);
    return CAIRO_STATUS_SUCCESS;
}

Surface surface_on(File& file, const Drawing& drawing, VectorFormat format) {
    const double width_pt = drawing.width_px * points_per_pixel(drawing);
    const double height_pt = drawing.height_px * points_per_pixel(drawing);
    if (format == VectorFormat::pdf) {
        return Surface(cairo_pdf_surface_create_for_stream(append, &file, width_pt, height_pt));
    }
    Surface surface(cairo_svg_surface_create_for_stream(append, &file, width_pt, height_pt));
    cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PT);
    return surface;
}

// Cairo keeps faces for a while after they were used: it keeps the font that they stand on, too.
FontFace face_of(const Typeface& typeface) {
    static const cairo_user_data_key_t owner_key{};
    constexpr int no_hinting = 2;  // FT_LOAD_NO_HINTING
    FontFace face(cairo_ft_font_face_create_for_ft_face(typeface.freetype_face(), no_hinting));
    if (cairo_font_face_get_user_data(face.get(), &owner_key) == nullptr) {
        auto owner = std::make_unique<std::shared_ptr<const void>>(typeface.owner());
        const auto release = [](void* kept) { delete static_cast<std::shared_ptr<const void>*>(kept); };
        if (cairo_font_face_set_user_data(face.get(), &owner_key, owner.get(), release) ==
            CAIRO_STATUS_SUCCESS) {
            static_cast<void>(owner.release());
        }
    }
    return face;
}

class Pen {
public:
    explicit Pen(cairo_t* context) : context_(context) {}

    void operator()(const DrawnArea& area) const {
        follow(area.outline);
        cairo_close_path(context_);
        take(area.colour, area.opacity);
        cairo_fill(context_);
    }

    void operator()(const DrawnLine& drawn) const {
        const std::vector<double>& dash_px = drawn.stroke.dash_px;
        follow(drawn.line);
        take(drawn.stroke.colour, 1.0);
        cairo_set_line_width(context_, drawn.stroke.width_px);
        cairo_set_line_join(context_, CAIRO_LINE_JOIN_ROUND);
        cairo_set_line_cap(context_, dash_px.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
        cairo_set_dash(context_, dash_px.data(), static_cast<int>(dash_px.size()), 0.0);
        cairo_stroke(context_);
    }

    void operator()(const DrawnText& drawn) {
        std::string text;
        std::vector<cairo_glyph_t> glyphs;
        std::vector<cairo_text_cluster_t> clusters;
        for (const PositionedGlyph& one : drawn.typeface.glyphs(drawn.text, drawn.size_px)) {
            const std::string letter = encode_utf8(std::u32string(1, one.character));
            text += letter;
            glyphs.push_back({one.index, one.x_px, 0.0});
            clusters.push_back({static_cast<int>(letter.size()), 1});
        }
        if (glyphs.empty()) { return; }
        cairo_save(context_);
        cairo_translate(context_, drawn.pen.x, drawn.pen.y);
        if (drawn.upwards) { cairo_rotate(context_, -std::numbers::pi / 2.0); }
        // One for all its texts: each face has a font of its own in the file.
        FontFace& face = faces_[drawn.typeface.freetype_face()];
        if (!face) { face = face_of(drawn.typeface); }
        cairo_set_font_face(context_, face.get());
        cairo_set_font_size(context_, drawn.size_px);
        take(drawn.colour, 1.0);
        cairo_show_text_glyphs(context_, text.data(), static_cast<int>(text.size()), glyphs.data(),
                               static_cast<int>(glyphs.size()), clusters.data(),
                               static_cast<int>(clusters.size()), static_cast<cairo_text_cluster_flags_t>(0));
        cairo_restore(context_);
    }

private:
    void follow(const Polyline& line) const {
        cairo_new_path(context_);
        for (const Point& point : line) { cairo_line_to(context_, point.x, point.y); }
    }
    void take(Colour colour, double opacity) const {
        cairo_set_source_rgba(context_, colour.red * of_255, colour.green * of_255, colour.blue * of_255,
                              opacity);
    }

    cairo_t* context_;
    std::map<FT_FaceRec_*, FontFace> faces_;
};

}  // namespace

std::vector<std::uint8_t> encode_vector(const Drawing& drawing, VectorFormat format) {
    File file;
    const Surface surface = surface_on(file, drawing, format);
    {
        const Context context(cairo_create(surface.get()));
        cairo_scale(context.get(), points_per_pixel(drawing), points_per_pixel(drawing));
        Pen pen(context.get());
        for (const auto& mark : drawing.marks) { std::visit(pen, mark); }
        cairo_show_page(context.get());
        if (const cairo_status_t status = cairo_status(context.get()); status != CAIRO_STATUS_SUCCESS) {
            throw std::runtime_error(std::string("a figure could not be drawn: ") +
                                     cairo_status_to_string(status));
        }
    }
    cairo_surface_finish(surface.get());
    if (const cairo_status_t status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS) {
        throw std::runtime_error(std::string("a figure could not be encoded: ") +
                                 cairo_status_to_string(status));
    }
    return file;
}

}  // namespace gyrolog
