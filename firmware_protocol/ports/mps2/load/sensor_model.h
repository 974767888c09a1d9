/// The synthetic sensor behind an SPI whose bytes take their time, with a timer as its sample clock.
#ifndef GYROLOG_PORT_MPS2_LOAD_SENSOR_MODEL_H
#define GYROLOG_PORT_MPS2_LOAD_SENSOR_MODEL_H

#include <stdbool.h>

void sensor_model_start(void);
void sensor_model_select(bool selected);

#endif
