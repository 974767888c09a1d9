// A cause's share of what is closed, as far as its likelihood tells.
#pragma once

#include <cstddef>
#include <string>

#include "analysis/diagnose/report.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// The effect happened at one time of one recording, which no other recording has.
bool is_event(const std::string& effect);

// The function takes the events out of a model's entries from `first_entry` on: another recording than the
// one they were found in has them not.
SensorModel without_events(SensorModel model, std::size_t first_entry);

// The function shares `shrink` out among the causes by their gains. Where the gap was measured on a second
// recording, an event of the first has no share.
void share_among_causes(Diagnosis& diagnosis);

}  // namespace gyrolog
