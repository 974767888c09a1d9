#include "usb_link.h"

#include <device/dcd.h>
#include <gyrolog_protocol/usb_identity.h>
#include <tusb.h>

#include "handlers.h"
#include "port.h"
#include "sample_timer.h"
#include "usb_controller.h"

enum {
    FRAME_NUMBER_MASK = 0x7FF,         // wraps after 2048 ms
    FRAME_COUNT_TICKS = CORE_HZ / 2U,  // between two looks at it
    // The number fixes the kind on some parts (SPEC 10.2); these numbers suit all.
    NOTIFICATION_IN = 0x81,
    DATA_OUT = 0x02,
    DATA_IN = 0x82,
    NOTIFICATION_BYTES = 8,
    CONTROL_INTERFACE_BYTES = 9 + 5 + 5 + 4 + 5 + 7,
    DATA_INTERFACE_BYTES = 9 + 7 + 7,
    CONFIGURATION_BYTES = TUD_CONFIG_DESC_LEN + CONTROL_INTERFACE_BYTES + DATA_INTERFACE_BYTES,
    DATA_INTERFACE = GLP_USB_INTERFACE_CONTROL + 1,
    LINE_CODING_AND_STATE = 2,  // of the requests of PSTN120, table 4
    CURRENT_mA = 100,
    TEXT_MAX = 2 * GLP_UID_BYTES
};

enum { TEXT_LANGUAGE, TEXT_MANUFACTURER, TEXT_PRODUCT, TEXT_SERIAL, TEXT_COUNT };

// Read back from the ELF by tools/firmware: not static, so that their names stay.
const tusb_desc_device_t usb_link_device_descriptor = {.bLength = sizeof(tusb_desc_device_t),
                                                       .bDescriptorType = TUSB_DESC_DEVICE,
                                                       .bcdUSB = 0x0200,
                                                       .bDeviceClass = TUSB_CLASS_CDC,
                                                       .bMaxPacketSize0 = CFG_TUD_ENDPOINT0_SIZE,
                                                       .idVendor = GLP_USB_VENDOR_ID,
                                                       .idProduct = GLP_USB_PRODUCT_ID,
                                                       .bcdDevice = 0x0100,
                                                       .iManufacturer = TEXT_MANUFACTURER,
                                                       .iProduct = TEXT_PRODUCT,
                                                       .iSerialNumber = TEXT_SERIAL,
                                                       .bNumConfigurations = 1};

#define DATA_PACKET_BYTES 64

// CDC120, section 5.3.3: one function, so that no association is needed. TinyUSB's own template has another
// protocol than SPEC 10.2.
// clang-format off
const uint8_t usb_link_configuration_descriptor[CONFIGURATION_BYTES] = {
    TUD_CONFIG_DESCRIPTOR(1, 2, 0, CONFIGURATION_BYTES, 0, CURRENT_mA),
    9, TUSB_DESC_INTERFACE, GLP_USB_INTERFACE_CONTROL, 0, 1, TUSB_CLASS_CDC,
       CDC_COMM_SUBCLASS_ABSTRACT_CONTROL_MODEL, CDC_COMM_PROTOCOL_ATCOMMAND, 0,
    5, TUSB_DESC_CS_INTERFACE, CDC_FUNC_DESC_HEADER, U16_TO_U8S_LE(0x0120),
    5, TUSB_DESC_CS_INTERFACE, CDC_FUNC_DESC_CALL_MANAGEMENT, 0, DATA_INTERFACE,
    4, TUSB_DESC_CS_INTERFACE, CDC_FUNC_DESC_ABSTRACT_CONTROL_MANAGEMENT, LINE_CODING_AND_STATE,
    5, TUSB_DESC_CS_INTERFACE, CDC_FUNC_DESC_UNION, GLP_USB_INTERFACE_CONTROL, DATA_INTERFACE,
    7, TUSB_DESC_ENDPOINT, NOTIFICATION_IN, TUSB_XFER_INTERRUPT, U16_TO_U8S_LE(NOTIFICATION_BYTES), 16,
    9, TUSB_DESC_INTERFACE, DATA_INTERFACE, 0, 2, TUSB_CLASS_CDC_DATA, 0, 0, 0,
    7, TUSB_DESC_ENDPOINT, DATA_OUT, TUSB_XFER_BULK, U16_TO_U8S_LE(DATA_PACKET_BYTES), 0,
    7, TUSB_DESC_ENDPOINT, DATA_IN, TUSB_XFER_BULK, U16_TO_U8S_LE(DATA_PACKET_BYTES), 0};
// clang-format on
_Static_assert(DATA_PACKET_BYTES == GLP_USB_PACKET_BYTES, "SPEC 10.2");

const char usb_link_product[] = GLP_USB_PRODUCT_PREFIX " " PORT_BOARD;

static char serial[TEXT_MAX + 1];
static void (*line_state_changed)(bool dtr);
static bool dtr_told;
static volatile bool bus_was_reset;
static uint32_t frames;
static uint32_t last_frame;
static uint32_t frames_counted_ticks;

static void tell(bool dtr) {
    if (dtr == dtr_told) { return; }
    dtr_told = dtr;
    line_state_changed(dtr);
}

static void write_serial(const uint8_t uid[GLP_UID_BYTES]) {
    static const char digit[] = "0123456789ABCDEF";
    for (size_t i = 0; i < GLP_UID_BYTES; ++i) {
        serial[2U * i] = digit[uid[i] >> 4U];
        serial[2U * i + 1U] = digit[uid[i] & 15U];
    }
}

void usb_link_start(const uint8_t uid[GLP_UID_BYTES], void (*on_line_state)(bool dtr)) {
    line_state_changed = on_line_state;
    write_serial(uid);
    usb_controller_start();
    const tusb_rhport_init_t device = {.role = TUSB_ROLE_DEVICE, .speed = TUSB_SPEED_FULL};
    tusb_init(0, &device);
}

static void count_frames(void) {
    if (!tud_ready()) { return; }  // no tokens come, and a suspended controller need not answer
    const uint32_t now = usb_controller_frame_number() & FRAME_NUMBER_MASK;
    frames += (now - last_frame) & FRAME_NUMBER_MASK;
    last_frame = now;
    frames_counted_ticks = sample_timer_now();
}

void usb_link_poll(void) {
    tud_task();
    usb_controller_poll();
    if (sample_timer_now() - frames_counted_ticks > FRAME_COUNT_TICKS) { count_frames(); }
    if (bus_was_reset) {
        bus_was_reset = false;
        tell(false);
    }
    tell(tud_cdc_connected());  // false also while suspended or not configured
}

bool usb_link_configured(void) { return tud_mounted(); }
size_t usb_link_read(uint8_t* bytes, size_t size) { return tud_cdc_read(bytes, size); }
size_t usb_link_write(const uint8_t* bytes, size_t size) {
    return tud_ready() ? tud_cdc_write(bytes, size) : 0U;
}
// TinyUSB ends a transfer of full packets by a zero-length one of its own accord when nothing follows.
void usb_link_flush(void) { tud_cdc_write_flush(); }
uint32_t usb_link_frame_number(void) {
    count_frames();
    return frames;
}

// ---------------------------------------------------------------------------- what TinyUSB asks for

// In the interrupt: a host that resets the bus and opens the port again between two polls must not look as if
// DTR had never fallen.
void tud_event_hook_cb(uint8_t rhport, uint32_t eventid, bool in_isr) {
    (void)rhport;
    (void)in_isr;
    if ((eventid == DCD_EVENT_BUS_RESET) || (eventid == DCD_EVENT_UNPLUGGED) ||
        (eventid == DCD_EVENT_SUSPEND)) {
        bus_was_reset = true;
    }
}

// Called from tud_task: each edge, also two within one poll.
void tud_cdc_line_state_cb(uint8_t itf, bool dtr, bool rts) {
    (void)itf;
    (void)rts;
    if (bus_was_reset) {
        bus_was_reset = false;
        tell(false);
    }
    tell(dtr);
}

const uint8_t* tud_descriptor_device_cb(void) { return (const uint8_t*)&usb_link_device_descriptor; }

const uint8_t* tud_descriptor_configuration_cb(uint8_t index) {
    (void)index;
    return usb_link_configuration_descriptor;
}

const uint16_t* tud_descriptor_string_cb(uint8_t index, uint16_t langid) {
    (void)langid;
    static uint16_t descriptor[1 + TEXT_MAX];
    static const char* const text[TEXT_COUNT] = {
        [TEXT_MANUFACTURER] = "gyrolog", [TEXT_PRODUCT] = usb_link_product, [TEXT_SERIAL] = serial};
    size_t length = 0;
    if (index == TEXT_LANGUAGE) {
        descriptor[1] = 0x0409;  // English, United States
        length = 1;
    } else if (index < TEXT_COUNT) {
        for (; (length < TEXT_MAX) && (text[index][length] != '\0'); ++length) {
            descriptor[1U + length] = (uint8_t)text[index][length];
        }
    } else {
        return NULL;
    }
    descriptor[0] = (uint16_t)((TUSB_DESC_STRING << 8U) | (2U * length + 2U));
    return descriptor;
}
