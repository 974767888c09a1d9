// What can be made to go wrong with a virtual board, and when.
#pragma once

#include <cstdint>

namespace gyrolog {

struct BoardFault {
    enum class Kind {
        fifo_overflow,     // the firmware's main loop stands still until the sensor's FIFO has run over
        bus_error,         // the next access to the sensor fails
        link_stall,        // the host takes nothing for `duration_s`
        drop_packet,       // 64 bytes of the stream never arrive
        duplicate_packet,  // 64 bytes arrive twice
        corrupt_byte,      // one byte arrives with a bit flipped
        reset,             // the microcontroller restarts, with a new boot id
        unplug,            // the device is gone, for `duration_s` or for good
        int_lost,          // the sensor's data-ready interrupt does not reach the firmware, likewise
        sensor_reset,      // the sensor forgets its set-up, as after a dip of its supply
        sensor_frozen,     // the sensor gives one reading again and again, for `duration_s` or for good
    };

    Kind kind = Kind::unplug;
    double at_s = 0.0;        // device time since the first start of the stream
    double duration_s = 0.0;  // of what may last; 0 is for good
};

}  // namespace gyrolog
