/// The board's pins: the sensor, and an LED of three colours. The table of wires is in the port's README.md.
#ifndef GYROLOG_PORT_PINS_H
#define GYROLOG_PORT_PINS_H

#include <stdbool.h>

typedef enum pins_led { pins_led_red, pins_led_green, pins_led_blue } pins_led;

void pins_start(void);
void pins_select_sensor(bool selected);
void pins_set_led(pins_led led, bool on);

#endif
