#include "analysis/plot/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include <png.h>
#include <zlib.h>

#include <opencv2/imgproc.hpp>

#include "analysis/plot/paper_size.hpp"

namespace gyrolog {
namespace {

constexpr int fineness = 2;       // fine pixels in a pixel
constexpr int fraction_bits = 4;  // OpenCV's fixed-point coordinates
constexpr double steps_per_fine_pixel = 1 << fraction_bits;

cv::Scalar scalar(Colour colour) { return {double(colour.blue), double(colour.green), double(colour.red)}; }

// OpenCV puts whole numbers on pixel centres, the figure on pixel corners.
cv::Point fixed_point(Point p) {
    return {static_cast<int>(std::lround((p.x * fineness - 0.5) * steps_per_fine_pixel)),
            static_cast<int>(std::lround((p.y * fineness - 0.5) * steps_per_fine_pixel))};
}

std::vector<cv::Point> fixed_points(const Polyline& line) {
    std::vector<cv::Point> points;
    points.reserve(line.size());
    for (const Point& p : line) { points.push_back(fixed_point(p)); }
    return points;
}

int fine_width(double width_px) { return std::max(1, static_cast<int>(std::lround(width_px * fineness))); }

cv::Rect fine_rect(const Box& box, const cv::Mat& sheet) {
    const auto fine = [](double px) { return static_cast<int>(std::lround(px * fineness)); };
    const cv::Rect rect(fine(box.left), fine(box.top), fine(box.right) - fine(box.left),
                        fine(box.bottom) - fine(box.top));
    return rect & cv::Rect({0, 0}, sheet.size());
}

std::uint8_t blended(std::uint8_t below, std::uint8_t above, double opacity) {
    return cv::saturate_cast<std::uint8_t>(below + (above - below) * opacity);
}

void blend(cv::Vec3b& pixel, Colour colour, double opacity) {
    pixel[0] = blended(pixel[0], colour.blue, opacity);
    pixel[1] = blended(pixel[1], colour.green, opacity);
    pixel[2] = blended(pixel[2], colour.red, opacity);
}

Polyline corners_of(const Box& box) {
    return {{box.left, box.top}, {box.right, box.top}, {box.right, box.bottom}, {box.left, box.bottom}};
}

Polyline outline_of(Marker marker, Point at, double r) {
    const auto polygon = [&](int corners, double first_rad, double radius) {
        Polyline outline;
        for (int i = 0; i < corners; ++i) {
            const double angle_rad = first_rad + 2.0 * CV_PI * i / corners;
            outline.push_back({at.x + radius * std::cos(angle_rad), at.y + radius * std::sin(angle_rad)});
        }
        return outline;
    };
    // Radii give the shapes about the same area.
    switch (marker) {
        case Marker::circle:
            return polygon(32, 0.0, r);
        case Marker::square:
            return polygon(4, CV_PI / 4.0, 1.22 * r);
        case Marker::triangle:
            return polygon(3, -CV_PI / 2.0, 1.45 * r);
        case Marker::diamond:
            return polygon(4, 0.0, 1.35 * r);
        case Marker::triangle_down:
            return polygon(3, CV_PI / 2.0, 1.45 * r);
        case Marker::hexagon:
            return polygon(6, 0.0, 1.12 * r);
        case Marker::none:
            break;
    }
    return {};
}

void lay_over(cv::Mat& picture, const TextMask& mask, Colour colour) {
    for (int row = 0; row < mask.height_px; ++row) {
        for (int column = 0; column < mask.width_px; ++column) {
            const cv::Point at(mask.left_px + column, mask.top_px + row);
            const auto index = static_cast<std::size_t>(row) * static_cast<std::size_t>(mask.width_px) +
                               static_cast<std::size_t>(column);
            if (mask.coverage[index] == 0 || !cv::Rect({0, 0}, picture.size()).contains(at)) { continue; }
            blend(picture.at<cv::Vec3b>(at), colour, mask.coverage[index] / 255.0);
        }
    }
}

// PNG's signature and its IHDR, which must come first (PNG, third edition, 5.2 and 5.6).
constexpr std::ptrdiff_t bytes_before_first_chunk = 8 + 4 + 4 + 13 + 4;

void append_big_endian(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
    for (const unsigned shift : {24U, 16U, 8U, 0U}) {
        bytes.push_back(static_cast<std::uint8_t>(value >> shift));
    }
}

// pHYs (PNG, third edition, 11.3.4.3): pixels in a metre. libpng's simple interface does not write it.
std::vector<std::uint8_t> physical_size_chunk(double dpi) {
    constexpr double inches_per_m = 1000.0 / mm_per_inch;
    constexpr std::uint32_t data_bytes = 4 + 4 + 1;
    constexpr std::uint8_t unit_is_metre = 1;
    constexpr std::size_t bytes_before_type = 4;
    const auto pixels_per_m = static_cast<std::uint32_t>(std::lround(dpi * inches_per_m));
    std::vector<std::uint8_t> chunk;
    append_big_endian(chunk, data_bytes);
    for (const char letter : std::string_view("pHYs")) { chunk.push_back(static_cast<std::uint8_t>(letter)); }
    append_big_endian(chunk, pixels_per_m);
    append_big_endian(chunk, pixels_per_m);
    chunk.push_back(unit_is_metre);
    const auto checked = static_cast<uInt>(chunk.size() - bytes_before_type);
    append_big_endian(chunk, static_cast<std::uint32_t>(crc32(0, chunk.data() + bytes_before_type, checked)));
    return chunk;
}

}  // namespace

Canvas::Canvas(int width_px, int height_px, double dpi)
    : fine_(height_px * fineness, width_px * fineness, CV_8UC3, scalar(colours::paper)),
      drawing_{width_px, height_px, dpi, {}} {
    drawing_.marks.emplace_back(
        DrawnArea{corners_of({0.0, 0.0, double(width_px), double(height_px)}), colours::paper});
}

void Canvas::fill(const Box& box, Colour colour, double opacity) {
    const cv::Rect rect = fine_rect(box, fine_);
    if (rect.empty()) { return; }
    drawing_.marks.emplace_back(DrawnArea{corners_of(box), colour, opacity});
    cv::Mat part = fine_(rect);
    if (opacity >= 1.0) {
        part.setTo(scalar(colour));
        return;
    }
    part.forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int*) { blend(pixel, colour, opacity); });
}

void Canvas::fill(const Polyline& polygon, Colour colour, double opacity) {
    if (polygon.size() < 3) { return; }
    drawing_.marks.emplace_back(DrawnArea{polygon, colour, opacity});
    const std::vector<std::vector<cv::Point>> outline{fixed_points(polygon)};
    if (opacity >= 1.0) {
        cv::fillPoly(fine_, outline, scalar(colour), cv::LINE_AA, fraction_bits);
        return;
    }
    // Only the rectangle around the polygon is blended.
    const int fixed_per_fine = 1 << fraction_bits;
    const cv::Rect fixed = cv::boundingRect(outline[0]);
    const cv::Point corner(fixed.x / fixed_per_fine - 2, fixed.y / fixed_per_fine - 2);
    const cv::Rect around =
        cv::Rect(corner, cv::Size(fixed.width / fixed_per_fine + 5, fixed.height / fixed_per_fine + 5)) &
        cv::Rect({0, 0}, fine_.size());
    if (around.empty()) { return; }
    cv::Mat coverage(around.size(), CV_8U, cv::Scalar(0));
    cv::fillPoly(coverage, outline, cv::Scalar(255), cv::LINE_AA, fraction_bits,
                 -around.tl() * fixed_per_fine);
    cv::Mat part = fine_(around);
    part.forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int* at) {
        const std::uint8_t covered = coverage.at<std::uint8_t>(at[0], at[1]);
        if (covered != 0) { blend(pixel, colour, opacity * covered / 255.0); }
    });
}

void Canvas::line(const Polyline& line, const Stroke& stroke) {
    if (stroke.width_px <= 0.0 || line.size() < 2) { return; }
    drawing_.marks.emplace_back(DrawnLine{line, stroke});
    for (const Polyline& piece : dashed(line, stroke.dash_px)) {
        if (piece.size() < 2) { continue; }
        cv::polylines(fine_, std::vector<std::vector<cv::Point>>{fixed_points(piece)}, false,
                      scalar(stroke.colour), fine_width(stroke.width_px), cv::LINE_AA, fraction_bits);
    }
}

void Canvas::rule(Point from, Point to, double width_px, Colour colour) {
    const double width = std::max(1.0, std::round(width_px));
    const auto first = [&](double centre) { return std::round(centre - width / 2.0); };
    if (from.x == to.x) {
        const double left = first(from.x);
        fill(Box{left, std::min(from.y, to.y), left + width, std::max(from.y, to.y)}, colour);
    } else {
        const double top = first(from.y);
        fill(Box{std::min(from.x, to.x), top, std::max(from.x, to.x), top + width}, colour);
    }
}

void Canvas::marker(Point at, Marker marker, double size_px, Colour colour, double outline_px) {
    if (marker == Marker::none) { return; }
    fill(outline_of(marker, at, size_px / 2.0 + outline_px), colours::paper);
    fill(outline_of(marker, at, size_px / 2.0), colour);
}

Box Canvas::text(const Typeface& typeface, std::string_view text, Point at, const TextStyle& style) {
    const double width_px = typeface.measure(text, style.size_px).width_px;
    const double cap_px = typeface.cap_height_px(style.size_px);
    const double back_px = style.across == Across::left     ? 0.0
                           : style.across == Across::centre ? width_px / 2.0
                                                            : width_px;
    const double down_px = style.along == Along::baseline ? 0.0
                           : style.along == Along::middle ? cap_px / 2.0
                                                          : cap_px;
    // Pen's start along the text, and its baseline, both in the picture's pixels.
    const double pen_px = style.upwards ? -(at.y + back_px) : at.x - back_px;
    const double base_px = style.upwards ? at.x + down_px : at.y + down_px;
    const double whole_pen_px = std::floor(pen_px);
    const Point pen = style.upwards ? Point{base_px, -pen_px} : Point{pen_px, base_px};
    drawing_.marks.emplace_back(
        DrawnText{typeface, std::string(text), style.size_px, style.colour, pen, style.upwards});

    TextMask mask = typeface.render(text, style.size_px, pen_px - whole_pen_px);
    mask.left_px += static_cast<int>(whole_pen_px);
    mask.top_px += static_cast<int>(std::lround(base_px));
    letterings_.push_back({style.upwards ? mask.turned_left() : std::move(mask), style.colour});
    const TextMask& drawn = letterings_.back().mask;
    return {double(drawn.left_px), double(drawn.top_px), double(drawn.left_px + drawn.width_px),
            double(drawn.top_px + drawn.height_px)};
}

cv::Mat Canvas::picture() const {
    cv::Mat picture;
    cv::resize(fine_, picture, {}, 1.0 / fineness, 1.0 / fineness, cv::INTER_AREA);
    for (const Lettering& lettering : letterings_) { lay_over(picture, lettering.mask, lettering.colour); }
    return picture;
}

// Not by OpenCV: its imgcodecs brings a hundred libraries, and with them 40 MB and 0.1 s to every command,
// captures included.
std::vector<std::uint8_t> encode_png(const cv::Mat& picture, double dpi) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(picture.cols);
    image.height = static_cast<png_uint_32>(picture.rows);
    image.format = PNG_FORMAT_BGR;
    const auto stride = static_cast<png_int_32>(picture.step[0]);
    std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(image));
    png_alloc_size_t size = bytes.size();
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.data, stride, nullptr) == 0) {
        throw std::runtime_error(std::string("a figure could not be encoded: ") + image.message);
    }
    bytes.resize(size);
    const std::vector<std::uint8_t> chunk = physical_size_chunk(dpi);
    bytes.insert(bytes.begin() + bytes_before_first_chunk, chunk.begin(), chunk.end());
    return bytes;
}

}  // namespace gyrolog
