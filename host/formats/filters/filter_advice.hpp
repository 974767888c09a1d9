// What a filter of white noise and random walk does not know of a sensor, as sentences for the head of its
// file: what the model or the analysis has beside N and K. A filter that is to be told of it needs an effort
// of its user, not larger numbers without a reason.
#pragma once

#include <string>
#include <vector>

#include "host/formats/export_source.hpp"

namespace gyrolog {

std::vector<std::string> filter_advice(const ExportSource& source);

}  // namespace gyrolog
