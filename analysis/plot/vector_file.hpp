// A drawing as a file of lines and letters, for paper: sharp at any size.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/plot/drawing.hpp"

namespace gyrolog {

enum class VectorFormat { svg, pdf };

// As large as the drawing's pixels to the inch make it. In a PDF the text is text, in a font that the file
// holds; in an SVG letters are shapes, which look alike everywhere.
std::vector<std::uint8_t> encode_vector(const Drawing& drawing, VectorFormat format);

}  // namespace gyrolog
