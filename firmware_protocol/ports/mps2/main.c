// The port: what the board's core is supplied with, and the main loop.
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "../../device/board.h"
#include "handlers.h"
#include "registers.h"
#include "sample_clock.h"
#include "synthetic_sensor.h"
#include "uart.h"

enum { RING_BYTES = 4096, RATE_MAX_mHz = 1000000 };

// Set by whoever starts the emulator; the linker script says where.
extern const volatile uint32_t loaded_boot_id;

static glp_board board;
static uint8_t ring[RING_BYTES];

static uint64_t ticks(void* context) {
    (void)context;
    return UINT32_MAX - TIMER0->value;
}

static bool sensor_write(void* context, uint8_t address, uint8_t value) {
    (void)context;
    interrupts_off();
    synthetic_sensor_write(address, value);
    sample_clock_follow_sensor(TIMERS_HZ);
    interrupts_on();
    return true;
}

static bool sensor_read(void* context, uint8_t address, uint8_t* bytes, size_t size) {
    (void)context;
    interrupts_off();
    synthetic_sensor_read(address, bytes, size);
    interrupts_on();
    return true;
}

static void delay_ms(void* context, uint32_t duration_ms) {
    const uint32_t begin = (uint32_t)ticks(context);
    while ((uint32_t)ticks(context) - begin < duration_ms * (TIMERS_HZ / 1000U)) {}
}

static size_t link_write(void* context, const uint8_t* bytes, size_t size) {
    (void)context;
    return uart_write(bytes, size);
}

static void link_flush(void* context) { (void)context; }  // a UART keeps nothing back

void on_sample_timer(void) {
    const uint64_t now = ticks(NULL);
    TIMER1->intclear = 1U;
    if (synthetic_sensor_sample()) { glp_board_on_data_ready(&board, now); }
}

static void start_clocks(void) {
    TIMER0->reload = UINT32_MAX;
    TIMER0->value = UINT32_MAX;
    TIMER0->ctrl = 1U;
    sample_clock_start();
}

void run(void) {
    static const glp_hal hal = {.sensor_on_spi = true,
                                .ticks = ticks,
                                .sensor_write = sensor_write,
                                .sensor_read = sensor_read,
                                .delay_ms = delay_ms,
                                .link_write = link_write,
                                .link_flush = link_flush};
    const glp_board_identity identity = {.uid = BOARD_NAME,
                                         .firmware = "gyrolog " BOARD_NAME,
                                         .tick_hz = TIMERS_HZ,
                                         .tick_bits = 32,
                                         .rate_max_mHz = RATE_MAX_mHz,
                                         .boot_id = loaded_boot_id,
                                         .reset_cause = glp_reset_power_on};
    synthetic_sensor_reset();
    start_clocks();
    uart_start();
    if (glp_board_init(&board, &hal, &identity, ring, sizeof ring)) { glp_board_boot(&board); }
    for (;;) {
        uint8_t bytes[64];
        const size_t size = uart_read(bytes, sizeof bytes);
        glp_board_on_receive(&board, bytes, size);
        glp_board_poll(&board);
        // A battery would want a WFI here. Under QEMU time must not pass but by instructions: while the core
        // waits, a late wake-up of the emulator would skip interrupts.
    }
}
