// Which boards `--device` names, given once or several times.
#pragma once

#include <string>
#include <vector>

#include "host/base/result.hpp"

namespace gyrolog {

// One URI a board: "usb:*" stands for every board on USB, each "usb:" of several for another one that is not
// named by its serial number, "sim:boards=N" for N boards. A single "usb:" stays what it is. Errors: those of
// finding boards on USB; not_found when there are fewer than asked for; invalid_argument when one is named
// twice.
Result<std::vector<std::string>> choose_devices(const std::vector<std::string>& asked);

// "night.pcapng" of the board "S1": "night-S1.pcapng". The number tells boards of the same serial number
// apart, from 1; of 0 there is but one.
std::string path_of_board(const std::string& path, const std::string& serial, unsigned number);

// The file that a device is made of, as a user names it: a recorded stream or a simulated board's model;
// empty for others, and for a name that is not understood.
std::string file_of_device(const std::string& uri);

}  // namespace gyrolog
