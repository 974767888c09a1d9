/// What the part knows about its own life: unique number, number of this boot, why it was reset, watchdog.
#ifndef GYROLOG_PORT_SUPERVISION_H
#define GYROLOG_PORT_SUPERVISION_H

#include <gyrolog_protocol/message.h>
#include <stdint.h>

/// Resets the part when supervision_feed stays away for 2 s. It cannot be switched off again.
void supervision_start_watchdog(void);
void supervision_feed(void);
void supervision_read_uid(uint8_t uid[GLP_UID_BYTES]);
/// A random number: differs from boot to boot, but does not count.
uint32_t supervision_boot_id(void);
glp_reset_cause supervision_reset_cause(void);

#endif
