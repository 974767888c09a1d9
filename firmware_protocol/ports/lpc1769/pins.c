#include "pins.h"

#include "registers.h"

enum {
    CHIP_SELECT = 6,  // P0.6, J6-8
    LED_RED = 22,     // P0.22
    LED_GREEN = 25,   // P3.25
    LED_BLUE = 26,    // P3.26
    PINS_A_REGISTER = 16
};

// UM10360, 8.5: the function of each pin is that of the tables of PINSEL0 to PINSEL10.
static void connect(unsigned port, unsigned pin, unsigned function, unsigned mode) {
    const unsigned at = 2U * port + pin / PINS_A_REGISTER;
    const unsigned shift = 2U * (pin % PINS_A_REGISTER);
    PIN_CONNECT->PINMODE[at] = (PIN_CONNECT->PINMODE[at] & ~(3UL << shift)) | ((uint32_t)mode << shift);
    PIN_CONNECT->PINSEL[at] = (PIN_CONNECT->PINSEL[at] & ~(3UL << shift)) | ((uint32_t)function << shift);
}

static void output(unsigned port, unsigned pin) {
    GPIO_PORT(port)->FIOSET = 1UL << pin;
    GPIO_PORT(port)->FIODIR |= 1UL << pin;
    connect(port, pin, 0U, PINMODE_NEITHER);
}

void pins_start(void) {
    SYSTEM->PCONP |= PCONP_GPIO;
    output(0U, CHIP_SELECT);
    output(0U, LED_RED);
    output(3U, LED_GREEN);
    output(3U, LED_BLUE);
    connect(0U, 7U, 2U, PINMODE_NEITHER);  // SCK1, J6-7
    connect(0U, 9U, 2U, PINMODE_NEITHER);  // MOSI1, J6-5
    // MISO1, J6-6; pulled up: an open line reads FF, which no register holds
    connect(0U, 8U, 2U, PINMODE_PULL_UP);
    connect(0U, 4U, 3U, PINMODE_PULL_DOWN);  // CAP2.0, J6-38; pulled down: an open line is silent
    connect(0U, 29U, 1U, PINMODE_NEITHER);   // USB_D+, J6-37
    connect(0U, 30U, 1U, PINMODE_NEITHER);   // USB_D-, J6-36
    // USB_CONNECT: switches the pull-up of D+. USB_VBUS (P1.30) stays as it is after reset: without a pin the
    // controller takes the cable's supply for present.
    connect(2U, 9U, 1U, PINMODE_NEITHER);
}

void pins_select_sensor(bool selected) {
    if (selected) {
        GPIO_PORT(0U)->FIOCLR = 1UL << CHIP_SELECT;
    } else {
        GPIO_PORT(0U)->FIOSET = 1UL << CHIP_SELECT;
    }
}

// The LEDs' anodes are at 3.3 V: low is on.
void pins_set_led(pins_led led, bool on) {
    static const struct {
        unsigned char port;
        unsigned char pin;
    } place[] = {
        [pins_led_red] = {0, LED_RED}, [pins_led_green] = {3, LED_GREEN}, [pins_led_blue] = {3, LED_BLUE}};
    if (on) {
        GPIO_PORT(place[led].port)->FIOCLR = 1UL << place[led].pin;
    } else {
        GPIO_PORT(place[led].port)->FIOSET = 1UL << place[led].pin;
    }
}
