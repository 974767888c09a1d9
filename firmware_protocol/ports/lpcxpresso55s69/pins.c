#include "pins.h"

#include <fsl_clock.h>

// UM11126, IOCON: the function of each pin is that of the table of pins.
enum {
    CHIP_SELECT = 1,  // P1_1, D10
    LED_BLUE = 4,     // P1_4
    LED_RED = 6,      // P1_6
    LED_GREEN = 7     // P1_7
};

// UM11126, IOCON, ASW: 0 opens the switch between a pin and the ADC, but for these pins it is 1.
static uint32_t analog_switch_open(unsigned port, unsigned pin) {
    static const uint32_t opened_by_1[] = {0x80049A00U, 0x00000201U};  // P0_9 11 12 15 18 31; P1_0 9
    return IOCON_PIO_ASW((opened_by_1[port] >> pin) & 1U);
}

static void digital(unsigned port, unsigned pin, unsigned function, unsigned mode) {
    IOCON->PIO[port][pin] = IOCON_PIO_FUNC(function) | IOCON_PIO_MODE(mode) | IOCON_PIO_SLEW(1U) |
                            IOCON_PIO_DIGIMODE(1U) | analog_switch_open(port, pin);
}

static void output(unsigned pin) {
    GPIO->SET[1] = 1UL << pin;
    GPIO->DIRSET[1] = 1UL << pin;
    digital(1U, pin, 0U, 0U);
}

void pins_start(void) {
    CLOCK_EnableClock(kCLOCK_Iocon);
    CLOCK_EnableClock(kCLOCK_Gpio1);
    output(CHIP_SELECT);
    output(LED_BLUE);
    output(LED_RED);
    output(LED_GREEN);
    digital(0U, 26U, 9U, 0U);  // HS_SPI_MOSI, D11
    digital(1U, 2U, 6U, 0U);   // HS_SPI_SCK, D13
    digital(1U, 3U, 6U, 2U);   // HS_SPI_MISO, D12; pulled up: an open line reads FF, which no register holds
    digital(0U, 15U, 3U, 1U);  // CT_INP16, D2; pulled down: an open line is silent
    digital(0U, 22U, 7U, 0U);  // USB0_VBUS: without it the controller never pulls D+ up
}

void pins_select_sensor(bool selected) {
    if (selected) {
        GPIO->CLR[1] = 1UL << CHIP_SELECT;
    } else {
        GPIO->SET[1] = 1UL << CHIP_SELECT;
    }
}

// The LEDs' anodes are at 3.3 V: low is on.
void pins_set_led(pins_led led, bool on) {
    static const unsigned char pin[] = {
        [pins_led_red] = LED_RED, [pins_led_green] = LED_GREEN, [pins_led_blue] = LED_BLUE};
    if (on) {
        GPIO->CLR[1] = 1UL << pin[led];
    } else {
        GPIO->SET[1] = 1UL << pin[led];
    }
}
