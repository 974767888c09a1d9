// What every page has around its sections: head, style, and by which program it was written.
#pragma once

#include <string>

#include "host/report/html.hpp"

namespace gyrolog {

std::string whole_page(const std::string& title, const Html& body);

}  // namespace gyrolog
