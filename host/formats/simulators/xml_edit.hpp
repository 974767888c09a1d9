// An XML file that stays as its user wrote it but for what is changed: blanks, comments and what else stands
// in it are kept byte by byte; within a tag, blanks between attributes become one and quotes double.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <pugixml.hpp>

#include "host/base/result.hpp"

namespace gyrolog {

// No entity is resolved, neither the text's own nor another file's. Error `malformed` with the place: no XML,
// more elements or nested deeper than input_limits has it.
Result<std::unique_ptr<pugi::xml_document>> parse_xml(std::string_view text);
std::string xml_text(const pugi::xml_document& document);

// The text in an element, without its comments.
std::string text_in(const pugi::xml_node& element);
void set_attribute(pugi::xml_node element, const char* name, const std::string& value);
// A child's text, or an attribute; what is that number already, to the digits that are written, stays as it
// is.
void set_number(pugi::xml_node parent, const char* child, double value);
void set_number_attribute(pugi::xml_node element, const char* name, double value);
// The first child of the name; where there is none, a new last one, indented as its neighbours are.
pugi::xml_node child_made(pugi::xml_node parent, const char* name);

// Puts comments before the root, in the place of those that were put there before: a head, and what follows
// it ("" for nothing).
void put_head(pugi::xml_document& document, const std::string& head, const std::string& footnote);

}  // namespace gyrolog
