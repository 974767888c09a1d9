// Of files in Python.
#pragma once

#include <string_view>

namespace gyrolog {

// The first line of every one. Python takes the encoding of a file from a comment of its first two lines that
// names one, whoever wrote it there; where the first line does, the second is not asked.
inline constexpr std::string_view python_encoding_line = "# -*- coding: utf-8 -*-\n";

}  // namespace gyrolog
