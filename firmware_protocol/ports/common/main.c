// What the board's core is supplied with, and the main loop. What differs between the ports is in their
// port.h.
#include "../../device/board.h"
#include "clocks.h"
#include "handlers.h"
#include "pins.h"
#include "port.h"
#include "sample_timer.h"
#include "sensor_bus.h"
#include "supervision.h"
#include "usb_link.h"

enum {
    RING_BYTES = 16384,  // 140 ms at 8 kHz with 14 bytes a sample
    RATE_MAX_mHz = 8000000,
    TICKS_PER_MS = CORE_HZ / 1000U
};

static glp_board board;
PORT_RING_SECTION static uint8_t ring[RING_BYTES];

static uint64_t ticks(void* context) {
    (void)context;
    return sample_timer_now();
}

static bool sensor_write(void* context, uint8_t address, uint8_t value) {
    (void)context;
    return sensor_bus_write(address, value);
}

static bool sensor_read(void* context, uint8_t address, uint8_t* bytes, size_t size) {
    (void)context;
    return sensor_bus_read(address, bytes, size);
}

// Only while the sensor is set up, never between samples.
static void delay_ms(void* context, uint32_t duration_ms) {
    (void)context;
    for (uint32_t i = 0; i < duration_ms; ++i) {
        sample_timer_wait(TICKS_PER_MS);
        supervision_feed();
    }
}

static size_t link_write(void* context, const uint8_t* bytes, size_t size) {
    (void)context;
    return usb_link_write(bytes, size);
}

static void link_flush(void* context) {
    (void)context;
    usb_link_flush();
}

static uint32_t usb_frame_number(void* context) {
    (void)context;
    return usb_link_frame_number();
}

static void on_edge(uint32_t edge_ticks) { glp_board_on_data_ready(&board, edge_ticks); }
static void on_line_state(bool dtr) { glp_board_on_line_state(&board, dtr); }

static const glp_hal hal = {.sensor_on_spi = true,
                            .ticks = ticks,
                            .sensor_write = sensor_write,
                            .sensor_read = sensor_read,
                            .delay_ms = delay_ms,
                            .link_write = link_write,
                            .link_flush = link_flush,
                            .usb_frame_number = usb_frame_number};

static void show_state(void) {
    pins_set_led(pins_led_red, !board.sensor_ready);
    pins_set_led(pins_led_green, usb_link_configured());
    pins_set_led(pins_led_blue, board.streaming);
}

static bool start(void) {
    // The watchdog first: a crystal that does not start ends in a reset, not in silence.
    supervision_start_watchdog();
    pins_start();
    pins_set_led(pins_led_red, true);
    clocks_start();
    sample_timer_start(on_edge);
    sensor_bus_start();
    glp_board_identity identity = {.firmware = PORT_FIRMWARE,
                                   .tick_hz = CORE_HZ,
                                   .tick_bits = 32,
                                   .rate_max_mHz = RATE_MAX_mHz,
                                   .boot_id = supervision_boot_id(),
                                   .reset_cause = supervision_reset_cause()};
    supervision_read_uid(identity.uid);
    if (!glp_board_init(&board, &hal, &identity, ring, sizeof ring)) { return false; }
    glp_board_boot(&board);  // a faulty sensor is told to the host
    usb_link_start(identity.uid, on_line_state);
    return true;
}

void run(void) {
    const bool started = start();
    while (started) {
        usb_link_poll();
        uint8_t bytes[64];
        const size_t size = usb_link_read(bytes, sizeof bytes);
        glp_board_on_receive(&board, bytes, size);
        glp_board_poll(&board);
        show_state();
        supervision_feed();
    }
}
