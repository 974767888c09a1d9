// The noise of the traces by frequency, as root of the two-sided power spectral density: white noise N lies
// at the height N, and what a data sheet calls noise density (one-sided) is sqrt(2) times as high.
#pragma once

#include "analysis/plot/allan_figure.hpp"

namespace gyrolog {

// In the same colours as the Allan curves; the legend is theirs. The strongest lines are marked: a steady one
// is lost in the average of its band, and its marker then stands at the peak of a spectrum as fine as the
// record allows.
Panel spectrum_panel(const AllanFigure& allan);

bool has_spectrum(const AllanFigure& allan);

}  // namespace gyrolog
