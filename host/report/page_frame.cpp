#include "host/report/page_frame.hpp"

#include "host/base/program_name.hpp"
#include "host/report/page_style.hpp"

namespace gyrolog {

std::string whole_page(const std::string& title, const Html& body) {
    const Html head = element(
        "head", Html::markup("<meta charset=\"utf-8\">\n"
                             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n") +
                    element("title", Html::text(title + " - gyrolog report")) +
                    element("style", Html::markup(page_style)));
    const Html footer = element("footer", Html::text("Written by " + program_name() + "."));
    const Html content = head + element("body", body + footer);
    return "<!DOCTYPE html>\n<html lang=\"en\">\n" + content.str() + "</html>\n";
}

}  // namespace gyrolog
