// The options of a simulated board as a user types them: sim:KEY=VALUE,...
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "firmware_protocol/device/mpu9250.h"
#include "host/base/result.hpp"
#include "host/virtual_board/board_fault.hpp"
#include "host/virtual_board/usb_descriptors.hpp"

namespace gyrolog {

//   model=FILE       a model, as `simulate` takes it; without it a typical MPU-9250. The capture is then the
//   signal
//                    that a simulation of the model with this seed gives, and both clocks of the board are
//                    true
//   rate=HZ          start-up output rate; without it the model's
//   full_scale=DPS   start-up range: 250 500 1000 2000; without it the smallest that holds the model's
//   dlpf=HZ|off      start-up low-pass; without it one that does not act at the rate, but for a typical
//                    MPU-9250 above 460 Hz: 184 Hz
//   seed=N           another sensor of the same kind
//   boards=N         how many boards there are
//   board=N          which of them this one is, from 1
//   realtime=1       keep to the clock
//   clock_ppm=X      the sensor's clock against nominal, within 10000; without it 0 for a given model,
//                    otherwise drawn from the seed
//   first_tick=N, first_sequence=N, boot_id=N, ring=BYTES
//   fault=KIND@SECONDS[+KIND@SECONDS...]   of device time since the start; KIND@FROM..TO for link_stall,
//                    unplug, int_lost and sensor_frozen
//                    kinds: fifo_overflow bus_error link_stall drop_packet duplicate_packet corrupt_byte
//                    reset unplug int_lost sensor_reset sensor_frozen
//   breach=NAME      break one rule of the protocol (breaches.cpp): for trying `gyrolog conform`
//   unplug=SECONDS, reset=SECONDS          the same as fault=unplug@SECONDS, fault=reset@SECONDS
//   replug=SECONDS   when the cable that unplug= pulled is back; without it the board is gone for good
//   self_powered=1   the board keeps its memory while it is unplugged; otherwise it boots anew
//   endpoints=fixed_kind   the endpoint addresses of controllers whose numbers fix the kind; without it free
//   sensor=NAME      mpu9250, mpu9255 or mpu9250_75 (sold as MPU-9250, WHO_AM_I 75): what WHO_AM_I says
struct SimOptions {
    std::string model_path;  // empty: typical_mpu9250()
    std::optional<double> rate_hz;
    std::optional<unsigned> full_scale_dps;
    std::optional<unsigned> dlpf_hz;  // GLP_DLPF_OFF for "off"
    std::uint64_t seed = 1;
    unsigned boards = 1;
    unsigned board = 1;
    bool realtime = false;
    std::optional<double> clock_error;
    std::uint64_t first_tick = 0;
    std::uint32_t first_sequence = 0;
    std::uint32_t boot_id = 1;
    std::size_t ring_bytes = 4096;
    std::vector<BoardFault> faults;
    std::optional<double> replug_s;  // as typed; already in `faults`
    bool self_powered = false;
    UsbEndpoints endpoints;
    std::uint8_t who_am_i = GLP_MPU_9250_ID;
    std::string breach;  // of breaches(); empty for an honest board
    std::string text;    // as typed, without boards= and board=
};

// Error `invalid_argument` names the option and what it may be.
Result<SimOptions> parse_sim_options(std::span<const std::pair<std::string, std::string>> options);

}  // namespace gyrolog
