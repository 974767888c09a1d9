#include "analysis/plot/legend.hpp"

#include <algorithm>
#include <cstddef>

#include "analysis/plot/paper_size.hpp"

namespace gyrolog {
namespace {

// At scale 1.
constexpr double row_px = 29.0;
constexpr double padding_px = 14.0;
constexpr double sample_px = 50.0;
constexpr double after_sample_px = 12.0;
constexpr double between_columns_px = 26.0;
constexpr double name_width_max_px = 320.0;

}  // namespace

Legend::Legend(const Panel& panel, const Typeface& typeface, double scale, std::optional<double> line_px)
    : typeface_(typeface), scale_(scale), header_(panel.legend_header), notes_(panel.notes) {
    const bool side_by_side = header_.size() > 1 || line_px;
    for (const Curve& curve : panel.curves) {
        if (curve.legend.empty()) { continue; }
        std::vector<std::string> cells = curve.legend;
        cells[0] =
            typeface.shortened(cells[0], letter_px * scale, name_width_max_px * scale, Ellipsis::middle);
        if (side_by_side && cells.size() == 1) {
            keys_.push_back({&curve, cells[0], 0.0, 0});
        } else {
            rows_.push_back({&curve, std::move(cells)});
        }
    }
    widen_columns(header_);
    for (const Row& row : rows_) { widen_columns(row.cells); }
    if (!rows_.empty() || !header_.empty()) {
        size_.width_px = (2.0 * padding_px + sample_px + after_sample_px) * scale_;
    }
    for (std::size_t i = 0; i < column_px_.size(); ++i) {
        size_.width_px += column_px_[i] + (i == 0 ? 0.0 : between_columns_px * scale_);
    }
    arrange_keys(line_px.value_or(size_.width_px));
    const double table_lines = static_cast<double>(rows_.size() + (header_.empty() ? 0 : 1));
    const double key_lines = keys_.empty() ? 0.0 : keys_.back().line + 1.0;
    const auto note_lines = static_cast<double>(notes_.size());
    for (const std::string& note : notes_) {
        size_.width_px = std::max(size_.width_px, width_px(note) + 2.0 * padding_px * scale_);
    }
    size_.height_px = ((table_lines + key_lines + note_lines) * row_px + padding_px) * scale_;
}

double Legend::width_px(const std::string& text) const {
    return typeface_.measure(text, letter_px * scale_).width_px;
}

void Legend::widen_columns(const std::vector<std::string>& cells) {
    column_px_.resize(std::max(column_px_.size(), cells.size()), 0.0);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        column_px_[i] = std::max(column_px_[i], width_px(cells[i]));
    }
}

// A key that is wider than the line widens the legend.
void Legend::arrange_keys(double line_px) {
    double left_px = padding_px * scale_;
    int line = 0;
    for (Key& key : keys_) {
        const double key_px = (sample_px + after_sample_px) * scale_ + width_px(key.name);
        const bool is_first = left_px == padding_px * scale_;
        if (!is_first && left_px + key_px + padding_px * scale_ > line_px) {
            left_px = padding_px * scale_;
            ++line;
        }
        key.left_px = left_px;
        key.line = line;
        size_.width_px = std::max(size_.width_px, left_px + key_px + padding_px * scale_);
        left_px += key_px + between_columns_px * scale_;
    }
}

void Legend::draw_sample(Canvas& canvas, Point left_middle, const Curve& curve) const {
    const double right = left_middle.x + sample_px * scale_;
    const double half_band_px = row_px * 0.34 * scale_;
    if (!curve.lo.empty()) {
        canvas.fill(Box{left_middle.x, left_middle.y - half_band_px, right, left_middle.y + half_band_px},
                    curve.stroke.colour, curve.band_opacity);
    }
    if (curve.stroke.width_px > 0.0) {
        canvas.line({left_middle, {right, left_middle.y}}, curve.stroke.scaled(scale_));
    }
    canvas.marker({(left_middle.x + right) / 2.0, left_middle.y}, curve.marker, curve.marker_size_px * scale_,
                  curve.stroke.colour, scale_);
}

void Legend::draw_cells(Canvas& canvas, Point left_middle, const std::vector<std::string>& cells,
                        Colour colour) const {
    double x = left_middle.x + (sample_px + after_sample_px) * scale_;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const bool is_name = i == 0;
        canvas.text(typeface_, cells[i], {is_name ? x : x + column_px_[i], left_middle.y},
                    {letter_px * scale_, colour, is_name ? Across::left : Across::right, Along::middle});
        x += column_px_[i] + between_columns_px * scale_;
    }
}

void Legend::draw(Canvas& canvas, const Box& box) const {
    const double edge_px = std::max(1.0, scale_);
    canvas.fill(box, colours::grid);
    canvas.fill(box.grown(-edge_px), colours::paper);
    Point at{box.left + padding_px * scale_, box.top + (padding_px / 2.0 + row_px / 2.0) * scale_};
    if (!header_.empty()) {
        draw_cells(canvas, at, header_, colours::muted_ink);
        at.y += row_px * scale_;
    }
    for (const Row& row : rows_) {
        draw_sample(canvas, at, *row.curve);
        draw_cells(canvas, at, row.cells, colours::ink);
        at.y += row_px * scale_;
    }
    for (const Key& key : keys_) {
        const Point here{box.left + key.left_px, at.y + key.line * row_px * scale_};
        draw_sample(canvas, here, *key.curve);
        canvas.text(typeface_, key.name, {here.x + (sample_px + after_sample_px) * scale_, here.y},
                    {letter_px * scale_, colours::ink, Across::left, Along::middle});
    }
    if (!keys_.empty()) { at.y += (keys_.back().line + 1) * row_px * scale_; }
    for (const std::string& note : notes_) {
        canvas.text(typeface_, note, {box.left + padding_px * scale_, at.y},
                    {letter_px * scale_, colours::ink, Across::left, Along::middle});
        at.y += row_px * scale_;
    }
}

}  // namespace gyrolog
