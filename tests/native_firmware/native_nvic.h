/* The interrupt controller's functions as CMSIS lets a build supply them (CMSIS_NVIC_VIRTUAL): a port calls
 * these. */
#ifndef GYROLOG_NATIVE_NVIC_H
#define GYROLOG_NATIVE_NVIC_H

#include <stdint.h>

void native_nvic_enable(int number);
void native_nvic_disable(int number);
uint32_t native_nvic_is_enabled(int number);
void native_nvic_set_priority(int number, uint32_t priority);

#define NVIC_EnableIRQ(number) native_nvic_enable((int)(number))
#define NVIC_DisableIRQ(number) native_nvic_disable((int)(number))
#define NVIC_GetEnableIRQ(number) native_nvic_is_enabled((int)(number))
#define NVIC_SetPriority(number, priority) native_nvic_set_priority((int)(number), (priority))
/* A line stays up until its peripheral is dealt with: nothing is latched that could be cleared. */
#define NVIC_ClearPendingIRQ(number) ((void)(number))

#endif
