// HTML as it is put together. Text becomes HTML in one way only, by being escaped: what a file, a device or a
// user calls itself cannot leave its place.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gyrolog {

class Html {
public:
    Html() = default;
    // What a reader sees is `text`; control characters and marks that turn the direction are spelt out.
    static Html text(std::string_view text);
    // Ours, as it stands in the source of this program.
    static Html markup(const char* ours) { return Html(ours); }

    Html& operator+=(const Html& more) {
        markup_ += more.markup_;
        return *this;
    }
    const std::string& str() const { return markup_; }
    bool empty() const { return markup_.empty(); }

private:
    explicit Html(std::string markup) : markup_(std::move(markup)) {}
    friend Html element(const char* tag, const Html& content, const char* css_class);
    friend Html png_image(std::span<const std::uint8_t> png, std::string_view seen);

    std::string markup_;
};

inline Html operator+(Html a, const Html& b) { return a += b; }

Html element(const char* tag, const Html& content, const char* css_class = nullptr);
Html paragraph(std::string_view text, const char* css_class = nullptr);
// Nothing without items.
Html bullet_list(std::span<const std::string> items);

// A row of one cell spans a table of several columns and heads the rows below it.
using HtmlRow = std::vector<Html>;
HtmlRow cells_of(std::initializer_list<std::string_view> texts);

struct HtmlTable {
    HtmlRow heads;  // empty: none
    std::vector<HtmlRow> rows;
    const char* css_class = nullptr;
};
// The first cell of a row is its head.
Html table(const HtmlTable& table);

// The picture itself is in the page. `seen` is for those who do not see it.
Html png_image(std::span<const std::uint8_t> png, std::string_view seen);
// Nothing without a picture.
Html figure(std::span<const std::uint8_t> png, std::string_view seen, std::string_view caption);
// In several pictures, between which a page may end.
Html figure_in_parts(std::span<const std::vector<std::uint8_t>> pngs, std::string_view seen,
                     std::string_view caption);

}  // namespace gyrolog
