#include "uart.h"

#include "handlers.h"
#include "registers.h"

enum { RECEIVED_MAX = 512 };  // a power of two

static uint8_t received[RECEIVED_MAX];
static volatile uint32_t received_in;   // the interrupt's
static volatile uint32_t received_out;  // the main loop's
static volatile uint32_t overruns;

void uart_start(void) {
    UART0->bauddiv = TIMERS_HZ / 921600U;
    UART0->ctrl = 1U | 2U | 8U;
    interrupt_enable(irq_uart0_receive);
}

void on_uart_receive(void) {
    UART0->intclear = 2U;
    while ((UART0->state & 2U) != 0U) {
        const uint8_t byte = (uint8_t)UART0->data;
        if (received_in - received_out == RECEIVED_MAX) {
            ++overruns;
            continue;
        }
        received[received_in % RECEIVED_MAX] = byte;
        ++received_in;
    }
}

size_t uart_write(const uint8_t* bytes, size_t size) {
    size_t accepted = 0;
    while ((accepted < size) && ((UART0->state & 1U) == 0U)) {
        UART0->data = bytes[accepted];
        ++accepted;
    }
    return accepted;
}

size_t uart_read(uint8_t* bytes, size_t capacity) {
    size_t size = 0;
    while ((size < capacity) && (received_out != received_in)) {
        bytes[size] = received[received_out % RECEIVED_MAX];
        ++size;
        ++received_out;
    }
    return size;
}
