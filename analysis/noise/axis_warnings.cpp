#include "analysis/noise/axis_warnings.hpp"

#include <algorithm>

namespace gyrolog {

void AxisWarnings::add(const std::string& axis, const std::string& text, const std::string& detail) {
    auto warning = std::ranges::find(warnings_, text, &Warning::text);
    if (warning == warnings_.end()) { warning = warnings_.insert(warning, {text, {}, 0}); }
    if (warning->count > 0 && !detail.empty()) { warning->axes += ','; }
    warning->axes += ' ' + axis;
    if (!detail.empty()) { warning->axes += " (" + detail + ')'; }
    ++warning->count;
}

std::vector<std::string> AxisWarnings::lines() const {
    std::vector<std::string> lines;
    for (const Warning& warning : warnings_) {
        lines.push_back((warning.count == 1 ? "axis" : "axes") + warning.axes + ": " + warning.text);
    }
    return lines;
}

}  // namespace gyrolog
