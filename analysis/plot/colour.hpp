// Colours that colour-blind readers tell apart, after Okabe and Ito, "Color Universal Design" (2008).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace gyrolog {

struct Colour {
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;

    friend bool operator==(const Colour&, const Colour&) = default;
};

namespace colours {

inline constexpr Colour paper{255, 255, 255};
inline constexpr Colour ink{28, 30, 34};
inline constexpr Colour muted_ink{96, 100, 108};
inline constexpr Colour grid{212, 214, 218};
inline constexpr Colour guide{150, 154, 160};
inline constexpr Colour fine_grid{237, 238, 240};

inline constexpr Colour blue{0, 114, 178};
inline constexpr Colour vermillion{213, 94, 0};
inline constexpr Colour green{0, 158, 115};
inline constexpr Colour purple{204, 121, 167};
inline constexpr Colour sky{86, 180, 233};
inline constexpr Colour orange{230, 159, 0};

// In the order to use them: the first three also differ in grey.
inline constexpr std::array<Colour, 6> cycle{blue, vermillion, green, purple, sky, orange};

}  // namespace colours

inline Colour mixed(Colour a, Colour b, double share_of_b) {
    const auto mix = [share_of_b](std::uint8_t x, std::uint8_t y) {
        return static_cast<std::uint8_t>(std::lround(x + (y - x) * share_of_b));
    };
    return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

}  // namespace gyrolog
