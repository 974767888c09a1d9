// A USB controller whose host takes each transfer at once, enumerates the board, opens its port and sends one
// CONFIGURE.
#include "usb_controller.h"

#include <device/dcd.h>
#include <gyrolog_protocol/frame.h>
#include <gyrolog_protocol/message.h>
#include <gyrolog_protocol/usb_identity.h>
#include <tusb.h>

#include "../../../src/memory.h"
#include "../registers.h"
#include "handlers.h"
#include "load_log.h"
#include "port.h"
#include "sample_timer.h"

enum { ENDPOINTS = 3, SETTLING_MS = 50, CLASS_TO_INTERFACE = 0x21 };

typedef struct transfer {
    uint8_t* buffer;
    uint16_t bytes;
    bool pending;
} transfer;

typedef enum host_step {
    host_resets,
    host_addresses,
    host_configures,
    host_opens,
    host_asks,
    host_waits,
    host_measures,
    host_done
} host_step;

// From whoever starts QEMU; the linker script says where.
extern const volatile struct load_wanted {
    uint32_t rate_mHz;
    uint32_t layout;
    uint32_t samples;
} loaded_load;

static transfer transfers[ENDPOINTS][2];  // by number and direction
static uint8_t data_out;
static host_step step;
static uint32_t asked_at;
static uint32_t first_sample;

void usb_controller_start(void) {}
uint32_t usb_controller_frame_number(void) { return sample_timer_now() / (CORE_HZ / 1000U); }
void on_usb(void) {}

static transfer* transfer_of(uint8_t endpoint) {
    return &transfers[tu_edpt_number(endpoint) % ENDPOINTS][tu_edpt_dir(endpoint)];
}

static void complete(uint8_t endpoint, uint32_t bytes) {
    transfer_of(endpoint)->pending = false;
    dcd_event_xfer_complete(0, endpoint, bytes, XFER_RESULT_SUCCESS, false);
}

static void complete_pending(void) {
    for (unsigned number = 0; number < ENDPOINTS; ++number) {
        const transfer* in = &transfers[number][TUSB_DIR_IN];
        if (in->pending) { complete((uint8_t)(number | TUSB_DIR_IN_MASK), in->bytes); }
    }
}

static void setup(uint8_t kind, uint8_t request, uint16_t value) {
    const tusb_control_request_t packet = {.bmRequestType = kind, .bRequest = request, .wValue = value};
    dcd_event_setup_received(0, (const uint8_t*)&packet, false);
}

static bool ask(void) {
    transfer* out = transfer_of(data_out);
    if (!out->pending) { return false; }
    const glp_configure configure = {.rate_mHz = loaded_load.rate_mHz,
                                     .dlpf_hz = (loaded_load.rate_mHz > 1000000U) ? 250U : 184U,
                                     .layout = (uint8_t)loaded_load.layout};
    uint8_t payload[16];
    const size_t size = glp_configure_write(&configure, payload, sizeof payload);
    const glp_frame frame = {glp_frame_configure, 0, 1, payload, size};
    const glp_cobs_result encoded = glp_frame_encode(&frame, out->buffer, out->bytes);
    complete(data_out, (uint32_t)encoded.size);
    asked_at = sample_timer_now();
    return true;
}

// What the host does next, once the control transfer before it has ended.
static void go_on(void) {
    switch (step) {
        case host_resets:
            dcd_event_bus_reset(0, TUSB_SPEED_FULL, false);
            step = host_addresses;
            break;
        case host_addresses:
            setup(0, TUSB_REQ_SET_ADDRESS, 7);
            step = host_configures;
            break;
        case host_configures:
            setup(0, TUSB_REQ_SET_CONFIGURATION, 1);
            step = host_opens;
            break;
        case host_opens:
            setup(CLASS_TO_INTERFACE, GLP_CDC_SET_CONTROL_LINE_STATE, GLP_CDC_LINE_DTR | GLP_CDC_LINE_RTS);
            step = host_asks;
            break;
        case host_asks:
            if (ask()) { step = host_waits; }
            break;
        case host_waits:
            if (sample_timer_now() - asked_at > SETTLING_MS * (CORE_HZ / 1000U)) {
                first_sample = load_now.samples;
                load_begin();
                step = host_measures;
            }
            break;
        default:
            if (load_now.samples - first_sample >= loaded_load.samples) { load_end(); }
    }
}

void usb_controller_poll(void) {
    interrupts_off();
    const uint32_t begin = sample_timer_now();
    complete_pending();
    go_on();
    load_apart_since(begin);
    interrupts_on();
}

// ---------------------------------------------------------------------------- what TinyUSB asks of a driver

bool dcd_init(uint8_t rhport, const tusb_rhport_init_t* rh_init) {
    (void)rhport;
    (void)rh_init;
    return true;
}

void dcd_int_handler(uint8_t rhport) { (void)rhport; }
void dcd_int_enable(uint8_t rhport) { (void)rhport; }
void dcd_int_disable(uint8_t rhport) { (void)rhport; }
void dcd_remote_wakeup(uint8_t rhport) { (void)rhport; }

void dcd_set_address(uint8_t rhport, uint8_t dev_addr) {
    (void)dev_addr;
    dcd_edpt_xfer(rhport, TUSB_DIR_IN_MASK, NULL, 0, false);
}

void dcd_sof_enable(uint8_t rhport, bool en) {
    (void)rhport;
    (void)en;
}

bool dcd_edpt_open(uint8_t rhport, const tusb_desc_endpoint_t* desc_ep) {
    (void)rhport;
    const bool bulk = desc_ep->bmAttributes.xfer == TUSB_XFER_BULK;
    if (bulk && (tu_edpt_dir(desc_ep->bEndpointAddress) == TUSB_DIR_OUT)) {
        data_out = desc_ep->bEndpointAddress;
    }
    return true;
}

void dcd_edpt_close_all(uint8_t rhport) { (void)rhport; }

bool dcd_edpt_xfer(uint8_t rhport, uint8_t ep_addr, uint8_t* buffer, uint16_t total_bytes, bool is_isr) {
    (void)rhport;
    (void)is_isr;
    *transfer_of(ep_addr) = (transfer){buffer, total_bytes, true};
    if ((tu_edpt_dir(ep_addr) == TUSB_DIR_IN) && (tu_edpt_number(ep_addr) != 0U)) {
        // The controller's DMA and the host.
        interrupts_off();
        const uint32_t begin = sample_timer_now();
        load_keep(buffer, total_bytes);
        load_apart_since(begin);
        interrupts_on();
    }
    return true;
}

void dcd_edpt_stall(uint8_t rhport, uint8_t ep_addr) {
    (void)rhport;
    transfer_of(ep_addr)->pending = false;
}

void dcd_edpt_clear_stall(uint8_t rhport, uint8_t ep_addr) {
    (void)rhport;
    (void)ep_addr;
}
