/// The board's pins: sensor on the Arduino headers, the RGB LED. The table of wires is in README.md.
#ifndef GYROLOG_PORT_LPCXPRESSO55S69_PINS_H
#define GYROLOG_PORT_LPCXPRESSO55S69_PINS_H

#include <stdbool.h>

typedef enum pins_led { pins_led_red, pins_led_green, pins_led_blue } pins_led;

void pins_start(void);
void pins_select_sensor(bool selected);
void pins_set_led(pins_led led, bool on);

#endif
