#include "host/formats/simulators/xml_edit.hpp"

#include <algorithm>
#include <cstring>
#include <sstream>

#include <fmt/format.h>

#include "host/formats/input_limits.hpp"
#include "host/formats/simulators/imported_model.hpp"
#include "host/formats/simulators/simulator_file.hpp"

namespace gyrolog {
namespace {

constexpr unsigned as_written = pugi::parse_cdata | pugi::parse_comments | pugi::parse_declaration |
                                pugi::parse_doctype | pugi::parse_fragment | pugi::parse_pi |
                                pugi::parse_ws_pcdata;

// Attributes are written in double quotes, whatever the user had.
class Requoter final : public pugi::xml_tree_walker {
public:
    bool for_each(pugi::xml_node& node) override {
        deepest_ = std::max(deepest_, depth());
        if (depth() > input_limits.xml_nesting_most) { return false; }
        for (pugi::xml_attribute attribute : node.attributes()) {
            if (std::strchr(attribute.value(), '"') != nullptr) { requote(attribute); }
        }
        return true;
    }
    bool too_deep() const { return deepest_ > input_limits.xml_nesting_most; }

private:
    static void requote(pugi::xml_attribute attribute) {
        std::string value;
        for (const char* c = attribute.value(); *c != '\0'; ++c) {
            if (*c == '"') {
                value += "&quot;";
            } else {
                value += *c;
            }
        }
        attribute.set_value(value.c_str());
    }

    int deepest_ = 0;
};

bool is_blank(const pugi::xml_node& node) {
    return node.type() == pugi::node_pcdata &&
           std::strspn(node.value(), " \t\r\n") == std::strlen(node.value());
}

// What stands before an element in its line; "" where something else does.
std::string indentation_of(const pugi::xml_node& element) {
    const pugi::xml_node before = element.previous_sibling();
    if (!before || !is_blank(before)) { return ""; }
    const std::string blanks = before.value();
    const std::size_t line_end = blanks.rfind('\n');
    return line_end == std::string::npos ? "" : blanks.substr(line_end + 1);
}

std::string written(double value) { return fmt::format("{:.9g}", value); }

bool is_written(std::string_view text, double value) {
    const auto number = finite_number(text);
    return number && written(*number) == written(value);
}

bool begins_alike(std::string_view comment, std::string_view footnote) {
    constexpr std::size_t characters = 40;
    return !footnote.empty() && comment.starts_with(footnote.substr(0, characters));
}

}  // namespace

Result<std::unique_ptr<pugi::xml_document>> parse_xml(std::string_view text) {
    if (static_cast<std::size_t>(std::ranges::count(text, '<')) > input_limits.xml_elements_most) {
        return malformed(
            fmt::format("more than {} elements: no model of a robot", input_limits.xml_elements_most));
    }
    auto document = std::make_unique<pugi::xml_document>();
    const pugi::xml_parse_result parsed =
        document->load_buffer(text.data(), text.size(), as_written, pugi::encoding_utf8);
    if (!parsed) {
        const auto at = text.begin() + std::clamp<std::ptrdiff_t>(parsed.offset, 0, std::ssize(text));
        return malformed(
            fmt::format("no XML: line {}: {}", 1 + std::count(text.begin(), at, '\n'), parsed.description()));
    }
    Requoter requoter;
    document->traverse(requoter);
    if (requoter.too_deep()) {
        return malformed(fmt::format("nested deeper than {} elements", input_limits.xml_nesting_most));
    }
    return document;
}

std::string xml_text(const pugi::xml_document& document) {
    std::ostringstream text;
    document.save(text, "", pugi::format_raw | pugi::format_no_escapes | pugi::format_no_declaration,
                  pugi::encoding_utf8);
    return std::move(text).str();
}

std::string text_in(const pugi::xml_node& element) {
    std::string text;
    for (const pugi::xml_node& child : element.children()) {
        if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) { text += child.value(); }
    }
    return text;
}

void set_number(pugi::xml_node parent, const char* child, double value) {
    pugi::xml_node element = child_made(parent, child);
    if (is_written(text_in(element), value)) { return; }
    while (element.remove_child(element.first_child())) {}
    element.append_child(pugi::node_pcdata).set_value(written(value).c_str());
}

void set_number_attribute(pugi::xml_node element, const char* name, double value) {
    if (!is_written(element.attribute(name).value(), value)) { set_attribute(element, name, written(value)); }
}

void set_attribute(pugi::xml_node element, const char* name, const std::string& value) {
    pugi::xml_attribute attribute = element.attribute(name);
    if (!attribute) { attribute = element.append_attribute(name); }
    attribute.set_value(value.c_str());
}

pugi::xml_node child_made(pugi::xml_node parent, const char* name) {
    if (pugi::xml_node there = parent.child(name)) { return there; }
    const std::string outer = "\n" + indentation_of(parent);
    std::string before = outer + "  ";
    if (const pugi::xml_node first = parent.first_child()) { before = is_blank(first) ? first.value() : ""; }
    pugi::xml_node last = parent.last_child();
    if (!last || !is_blank(last)) {
        last = parent.append_child(pugi::node_pcdata);
        last.set_value(before.empty() ? "" : outer.c_str());
    }
    pugi::xml_node made = parent.insert_child_before(name, last);
    if (!before.empty()) { parent.insert_child_before(pugi::node_pcdata, made).set_value(before.c_str()); }
    return made;
}

void put_head(pugi::xml_document& document, const std::string& head, const std::string& footnote) {
    for (pugi::xml_node node = document.first_child(); node;) {
        pugi::xml_node next = node.next_sibling();
        if (node.type() == pugi::node_comment &&
            (is_own_head(node.value()) || begins_alike(node.value(), footnote))) {
            const pugi::xml_node blank = next;
            if (is_blank(blank)) {
                next = blank.next_sibling();
                document.remove_child(blank);
            }
            document.remove_child(node);
        }
        node = next;
    }
    const pugi::xml_node root = document.document_element();
    for (const std::string* comment : {&head, &footnote}) {
        if (comment->empty()) { continue; }
        document.insert_child_before(pugi::node_comment, root).set_value(comment->c_str());
        document.insert_child_before(pugi::node_pcdata, root).set_value("\n");
    }
}

}  // namespace gyrolog
