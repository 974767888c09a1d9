#include "host/report/html.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "host/base/printable.hpp"
#include "host/report/base64.hpp"

namespace gyrolog {
namespace {

std::string escaped(std::string_view text) {
    std::string safe;
    safe.reserve(text.size());
    for (const char character : text) {
        switch (character) {
            case '&':
                safe += "&amp;";
                break;
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '"':
                safe += "&quot;";
                break;
            case '\'':
                safe += "&#39;";
                break;
            default:
                safe += character;
        }
    }
    return safe;
}

// <tr><th scope="colgroup" colspan="4">N, angle random walk</th></tr>
Html spanning_row(const Html& cell, std::size_t columns) {
    const std::string opening = fmt::format(R"(<th scope="colgroup" colspan="{}">)", columns);
    return element("tr", Html::markup(opening.c_str()) + cell + Html::markup("</th>"), "group");
}

Html row_of(const HtmlRow& cells, std::size_t columns) {
    if (cells.size() == 1 && columns > 1) { return spanning_row(cells.front(), columns); }
    Html row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i == 0) {
            row += Html::markup(R"(<th scope="row">)") + cells[i] + Html::markup("</th>");
        } else {
            row += element("td", cells[i]);
        }
    }
    return element("tr", row);
}

Html head_row(const HtmlRow& heads) {
    Html row;
    for (const Html& head : heads) {
        row += Html::markup(R"(<th scope="col">)") + head + Html::markup("</th>");
    }
    return element("thead", element("tr", row));
}

}  // namespace

Html Html::text(std::string_view text) { return Html(escaped(printable(text))); }

Html element(const char* tag, const Html& content, const char* css_class) {
    const std::string attribute = css_class == nullptr ? "" : fmt::format(R"( class="{}")", css_class);
    return Html(fmt::format("<{0}{1}>{2}</{0}>\n", tag, attribute, content.str()));
}

Html paragraph(std::string_view text, const char* css_class) {
    return element("p", Html::text(text), css_class);
}

Html bullet_list(std::span<const std::string> items) {
    if (items.empty()) { return {}; }
    Html list;
    for (const std::string& item : items) { list += element("li", Html::text(item)); }
    return element("ul", list);
}

HtmlRow cells_of(std::initializer_list<std::string_view> texts) {
    HtmlRow cells;
    for (const std::string_view text : texts) { cells.push_back(Html::text(text)); }
    return cells;
}

Html table(const HtmlTable& table) {
    std::size_t columns = table.heads.size();
    for (const HtmlRow& row : table.rows) { columns = std::max(columns, row.size()); }
    Html body;
    for (const HtmlRow& row : table.rows) { body += row_of(row, columns); }
    const Html head = table.heads.empty() ? Html() : head_row(table.heads);
    return element("table", head + element("tbody", body), table.css_class);
}

Html png_image(std::span<const std::uint8_t> png, std::string_view seen) {
    return Html(fmt::format(R"(<img alt="{}" src="data:image/png;base64,{}">)", escaped(printable(seen)),
                            base64(png)));
}

Html figure(std::span<const std::uint8_t> png, std::string_view seen, std::string_view caption) {
    if (png.empty()) { return {}; }
    return element("figure", png_image(png, seen) + element("figcaption", Html::text(caption)));
}

Html figure_in_parts(std::span<const std::vector<std::uint8_t>> pngs, std::string_view seen,
                     std::string_view caption) {
    if (pngs.empty()) { return {}; }
    Html pictures;
    for (std::size_t i = 0; i < pngs.size(); ++i) {
        pictures += png_image(pngs[i], fmt::format("{}, {} of {}", seen, i + 1, pngs.size()));
    }
    return element("figure", pictures + element("figcaption", Html::text(caption)));
}

}  // namespace gyrolog
