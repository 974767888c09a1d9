#include <gyrolog_protocol/crc.h>

#include "little_endian.h"

#ifdef GLP_CRC_SMALL

// One entry for each value of four bits: 64 bytes of flash instead of 8 KiB.
static const uint32_t nibble_table[16] = {
    0x00000000U, 0x1DB71064U, 0x3B6E20C8U, 0x26D930ACU, 0x76DC4190U, 0x6B6B51F4U, 0x4DB26158U, 0x5005713CU,
    0xEDB88320U, 0xF00F9344U, 0xD6D6A3E8U, 0xCB61B38CU, 0x9B64C2B0U, 0x86D3D2D4U, 0xA00AE278U, 0xBDBDF21CU};

uint32_t glp_crc32_continue(uint32_t crc, const uint8_t* bytes, size_t size) {
    crc = ~crc;
    for (size_t i = 0; i < size; ++i) {
        crc ^= bytes[i];
        crc = (crc >> 4U) ^ nibble_table[crc & 0x0FU];
        crc = (crc >> 4U) ^ nibble_table[crc & 0x0FU];
    }
    return ~crc;
}

#else

    #include "crc_table.h"

// Eight bytes a step. table[k][b] is the remainder that byte b leaves once k further zero bytes have followed
// it, so the eight bytes' parts can be looked up side by side and added (Kounavis and Berry, 2005,
// "slicing-by-8").
uint32_t glp_crc32_continue(uint32_t crc, const uint8_t* bytes, size_t size) {
    crc = ~crc;
    for (; size >= 8U; size -= 8U, bytes += 8) {
        const uint32_t low = glp_load_u32(bytes) ^ crc;
        const uint32_t high = glp_load_u32(bytes + 4);
        crc = table[7][low & 0xFFU] ^ table[6][(low >> 8U) & 0xFFU] ^ table[5][(low >> 16U) & 0xFFU] ^
              table[4][low >> 24U] ^ table[3][high & 0xFFU] ^ table[2][(high >> 8U) & 0xFFU] ^
              table[1][(high >> 16U) & 0xFFU] ^ table[0][high >> 24U];
    }
    for (; size > 0U; --size, ++bytes) { crc = (crc >> 8U) ^ table[0][(crc ^ *bytes) & 0xFFU]; }
    return ~crc;
}

#endif

uint32_t glp_crc32(const uint8_t* bytes, size_t size) { return glp_crc32_continue(0U, bytes, size); }
