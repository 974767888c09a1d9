/// CRC-32 (polynomial 0x04C11DB7, reflected, initial value and final xor 0xFFFFFFFF): the one of IEEE 802.3
/// and zlib. Check value: the nine characters "123456789" give 0xCBF43926.
#ifndef GYROLOG_PROTOCOL_CRC_H
#define GYROLOG_PROTOCOL_CRC_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Checksum of `size` bytes. glp_crc32_continue(glp_crc32(a), b) is the checksum of a followed by b.
uint32_t glp_crc32(const uint8_t* bytes, size_t size);
uint32_t glp_crc32_continue(uint32_t crc, const uint8_t* bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
