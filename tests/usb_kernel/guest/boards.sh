# Functions that plug boards into the guest. Sourced by the scenarios.

gadget=/sys/kernel/config/usb_gadget/board

# wait_for SECONDS COMMAND...: until COMMAND succeeds; fails when it has not done so in time.
wait_for() {
    tries=$(($1 * 10))
    shift
    until "$@" > /dev/null 2>&1; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || return 1
        sleep 0.1
    done
}

# usb_present SERIAL: whether the bus has a device of that serial number.
usb_present() { grep -qsx "$1" /sys/bus/usb/devices/*/serial; }

# The board on the kernel's own ACM function, with the identity of the real one: usb_identity.h, usb_function.hpp.
# plug_acm_gadget SERIAL
plug_acm_gadget() {
    mkdir -p $gadget/strings/0x409 $gadget/configs/c.1/strings/0x409 $gadget/functions/acm.0
    echo 0x1fc9 > $gadget/idVendor
    echo 0x0083 > $gadget/idProduct
    echo gyrolog > $gadget/strings/0x409/manufacturer
    echo "gyrolog MPU-9250 on an ACM gadget" > $gadget/strings/0x409/product
    echo "$1" > $gadget/strings/0x409/serialnumber
    ln -s $gadget/functions/acm.0 $gadget/configs/c.1
    echo dummy_udc.0 > $gadget/UDC
    wait_for 10 usb_present "$1"
    wait_for 10 test -c /dev/ttyACM0
}

unplug_acm_gadget() { echo > $gadget/UDC; }

# The ACM function keeps DTR to itself (f_acm.c, acm_setup): no ioctl on ttyGS0 tells it. A probe on the function that
# receives the host's SET_CONTROL_LINE_STATE writes it to trace_pipe, one line a request with " value=N".
trace_line_state() {
    echo 'p:line_state usb_f_acm:acm_setup request=+1($arg2):u8 value=+2($arg2):u16' > /sys/kernel/tracing/kprobe_events
    echo 'request == 0x22' > /sys/kernel/tracing/events/kprobes/line_state/filter
    echo 1 > /sys/kernel/tracing/events/kprobes/line_state/enable
}
