/// What the vectors lead to.
#ifndef GYROLOG_PROTOCOL_PORTS_MPS2_HANDLERS_H
#define GYROLOG_PROTOCOL_PORTS_MPS2_HANDLERS_H

void reset(void);
void run(void);
void on_uart_receive(void);
void on_sample_timer(void);

#endif
