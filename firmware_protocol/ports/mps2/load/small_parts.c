// What a board has and this one does without.
#include <gyrolog_protocol/message.h>

#include "../../../src/memory.h"
#include "clocks.h"
#include "load_log.h"
#include "pins.h"
#include "sensor_model.h"
#include "supervision.h"

static volatile bool leds[3];

void clocks_start(void) {}
void pins_start(void) {}
void pins_select_sensor(bool selected) { sensor_model_select(selected); }
void pins_set_led(pins_led led, bool on) { leds[led] = on; }

void supervision_start_watchdog(void) {}
void supervision_feed(void) { load_turn_ended(); }  // the last call of a turn
void supervision_read_uid(uint8_t uid[GLP_UID_BYTES]) { memset(uid, 0x55, GLP_UID_BYTES); }
uint32_t supervision_boot_id(void) { return 1; }
glp_reset_cause supervision_reset_cause(void) { return glp_reset_power_on; }
