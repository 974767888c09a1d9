// A board of a port, native: its firmware on the processor, the part's USB controller, an MPU-9250 at its
// SPI.
//
// The port's own: main loop, sensor bus, descriptors and USB link, controller start, TinyUSB with the part's
// driver, the board's core. Replaced, each behind the header that the shared code knows it by: clocks, pins,
// SPI, sample timer, supervision (board_seams.cpp); their registers are in the model that the image itself
// runs on (tests/firmware_image).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <gyrolog_protocol/message.h>

#include "firmware_protocol/device/board.h"
#include "host/virtual_board/simulated_mpu9250.hpp"
#include "tests/native_firmware/part.hpp"
#include "tests/native_firmware/processor.hpp"
#include "tests/native_firmware/usb_device.hpp"

namespace gyrolog {

struct NativeBoardOptions {
    std::array<std::uint8_t, GLP_UID_BYTES> uid = {0xA1, 0xB2, 0xC3, 0xD4, 1, 2,  3,  4,
                                                   5,    6,    7,    8,    9, 10, 11, 12};
    std::uint64_t seed = 1;
    double sensor_clock_error = 0.003;  // PS-MPU-9250A-01, table 1: 1 % at most
    std::uint32_t boot_id = 1;
};

enum class Led { red, green, blue };

// One at a time.
class NativeBoard final : private Surroundings {
public:
    // Powers it on: the firmware's variables are as its linker script has them at the start.
    explicit NativeBoard(const NativeBoardOptions& options);
    ~NativeBoard() override;
    NativeBoard(const NativeBoard&) = delete;
    NativeBoard& operator=(const NativeBoard&) = delete;

    Processor& processor() { return processor_; }
    UsbDevice& usb() { return part_->usb(); }
    bool lit(Led led) const { return lit_[static_cast<std::size_t>(led)]; }
    // The core's state, as the firmware's main loop has it.
    const glp_board& firmware() const;
    // Ticks of all edges of the sensor's data-ready line since power-on.
    const std::vector<std::uint64_t>& edges_ticks() const { return edges_ticks_; }

    // --- For the firmware's side.
    const NativeBoardOptions& options() const { return options_; }
    void light(Led led, bool on) { lit_[static_cast<std::size_t>(led)] = on; }
    void capture_edges(void (*on_edge)(std::uint32_t ticks));
    void select_sensor(bool selected);
    void set_spi_fast(bool fast);
    void restart_spi();
    bool spi_put(std::uint8_t byte);
    bool spi_get(std::uint8_t& byte);

private:
    static constexpr std::size_t spi_entries = 8;  // of each FIFO, on both parts

    struct InFlight {
        std::uint8_t out;
        std::uint64_t done_ticks;
    };

    std::uint64_t next_event_ticks() const override;
    void pass_event(std::uint64_t now_ticks) override;
    std::uint8_t exchange(std::uint8_t byte);

    NativeBoardOptions options_;
    Processor processor_;
    std::unique_ptr<Part> part_;
    SimulatedMpu9250 sensor_;
    std::array<bool, 3> lit_{};
    std::vector<std::uint64_t> edges_ticks_;

    void (*on_edge_)(std::uint32_t ticks) = nullptr;
    bool captured_ = false;
    std::uint32_t capture_ticks_ = 0;

    std::vector<InFlight> spi_;
    std::uint64_t spi_byte_ticks_ = 0;
    bool selected_ = false;
    bool addressed_ = false;
    bool reads_ = false;
    std::uint8_t address_ = 0;
};

// The board that the firmware of this program runs on.
NativeBoard& the_board();

}  // namespace gyrolog
