/// What the vectors of this port point to.
#ifndef GYROLOG_PORT_HANDLERS_H
#define GYROLOG_PORT_HANDLERS_H

void reset(void);
void run(void);
void on_data_ready_capture(void);
void on_usb(void);

#endif
