/// The line to the host.
///
/// Invariant: bytes are taken in the order in which they came. What finds no room is counted, and its command
/// is lost: the frame's checksum tells.
#ifndef GYROLOG_PROTOCOL_PORTS_MPS2_UART_H
#define GYROLOG_PROTOCOL_PORTS_MPS2_UART_H

#include <stddef.h>
#include <stdint.h>

void uart_start(void);
/// Without waiting; returns how many were accepted.
size_t uart_write(const uint8_t* bytes, size_t size);
/// What has come, at most `capacity`.
size_t uart_read(uint8_t* bytes, size_t capacity);

#endif
