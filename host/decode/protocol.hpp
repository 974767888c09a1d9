// The firmware's C headers, seen from C++.
#pragma once

extern "C" {
#include <gyrolog_protocol/frame.h>
#include <gyrolog_protocol/frame_stream.h>
#include <gyrolog_protocol/message.h>
#include <gyrolog_protocol/status.h>
#include <gyrolog_protocol/version.h>
}
