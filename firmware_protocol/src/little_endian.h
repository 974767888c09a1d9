/// Fields of the wire format, whatever the machine's own order and alignment.
#ifndef GYROLOG_PROTOCOL_SRC_LITTLE_ENDIAN_H
#define GYROLOG_PROTOCOL_SRC_LITTLE_ENDIAN_H

#include <stdint.h>

static inline uint16_t glp_load_u16(const uint8_t* bytes) {
    return (uint16_t)(bytes[0] | ((uint16_t)bytes[1] << 8U));
}

static inline uint32_t glp_load_u32(const uint8_t* bytes) {
    return (uint32_t)bytes[0] | ((uint32_t)bytes[1] << 8U) | ((uint32_t)bytes[2] << 16U) |
           ((uint32_t)bytes[3] << 24U);
}

static inline uint64_t glp_load_u64(const uint8_t* bytes) {
    return (uint64_t)glp_load_u32(bytes) | ((uint64_t)glp_load_u32(bytes + 4) << 32U);
}

static inline void glp_store_u16(uint8_t* bytes, uint16_t value) {
    bytes[0] = (uint8_t)value;
    bytes[1] = (uint8_t)(value >> 8U);
}

static inline void glp_store_u32(uint8_t* bytes, uint32_t value) {
    glp_store_u16(bytes, (uint16_t)value);
    glp_store_u16(bytes + 2, (uint16_t)(value >> 16U));
}

static inline void glp_store_u64(uint8_t* bytes, uint64_t value) {
    glp_store_u32(bytes, (uint32_t)value);
    glp_store_u32(bytes + 4, (uint32_t)(value >> 32U));
}

#endif
