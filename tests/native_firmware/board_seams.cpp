// What the shared code of the ports asks of a port, where registers are not the matter: clocks, pins, SPI,
// sample timer, supervision, and the processor's own instructions. The headers are the ports'.
#include <algorithm>

extern "C" {
#include "firmware_protocol/ports/common/pins.h"
#include "firmware_protocol/ports/common/sample_timer.h"
#include "firmware_protocol/ports/common/spi.h"
#include "firmware_protocol/ports/common/supervision.h"
#include "tests/native_firmware/native_nvic.h"
void clocks_start();
}

#include "tests/native_firmware/native_board.hpp"

using gyrolog::Led;
using gyrolog::the_board;
using gyrolog::the_processor;

extern "C" {

void clocks_start() {}

// ---------------------------------------------------------------------------- pins.h

void pins_start() {}
void pins_select_sensor(bool selected) { the_board().select_sensor(selected); }
void pins_set_led(pins_led led, bool on) { the_board().light(static_cast<Led>(led), on); }

// ---------------------------------------------------------------------------- sample_timer.h

void sample_timer_start(void (*on_edge)(std::uint32_t ticks)) { the_board().capture_edges(on_edge); }

std::uint32_t sample_timer_now() {
    the_processor().access(0, 0, false);
    return static_cast<std::uint32_t>(the_processor().now_ticks());
}

void sample_timer_wait(std::uint32_t ticks) {
    the_processor().note_work();
    the_processor().wait(ticks);
}

// ---------------------------------------------------------------------------- spi.h

void spi_start() { the_board().restart_spi(); }
void spi_set_fast(bool fast) { the_board().set_spi_fast(fast); }
bool spi_put(std::uint8_t byte) { return the_board().spi_put(byte); }
bool spi_get(std::uint8_t* byte) { return the_board().spi_get(*byte); }

// ---------------------------------------------------------------------------- supervision.h

void supervision_start_watchdog() {}
void supervision_feed() { the_processor().end_turn(); }
void supervision_read_uid(std::uint8_t uid[GLP_UID_BYTES]) {
    std::copy_n(the_board().options().uid.begin(), GLP_UID_BYTES, uid);
}
std::uint32_t supervision_boot_id() { return the_board().options().boot_id; }
glp_reset_cause supervision_reset_cause() { return glp_reset_power_on; }

// ---------------------------------------------------------------------------- native_nvic.h

void native_nvic_enable(int number) {
    the_processor().line(number).enabled = true;
    the_processor().interrupts_changed();
}
void native_nvic_disable(int number) { the_processor().line(number).enabled = false; }
std::uint32_t native_nvic_is_enabled(int number) { return the_processor().line(number).enabled ? 1 : 0; }
void native_nvic_set_priority(int number, std::uint32_t priority) {
    the_processor().line(number).priority = priority;
}
}
