// Warnings about axes, for a reader: one that several axes share is one line.
#pragma once

#include <string>
#include <vector>

namespace gyrolog {

class AxisWarnings {
public:
    // `detail`: what is this axis' own, as a number. Axes with the same `text` share a line whatever it is.
    void add(const std::string& axis, const std::string& text, const std::string& detail = {});

    // In the order in which their texts first came:
    //   axes x y: the text
    //   axes x (detail), y (detail): the text
    std::vector<std::string> lines() const;

private:
    struct Warning {
        std::string text;
        std::string axes;
        std::size_t count = 0;
    };
    std::vector<Warning> warnings_;
};

}  // namespace gyrolog
