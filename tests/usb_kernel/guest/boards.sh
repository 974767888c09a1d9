# Boards that can be plugged into the guest.

gadget=/sys/kernel/config/usb_gadget/board

# plug_vhci_board SERIAL [OPTION...]: the virtual board on vhci_hcd, in the background as job board-SERIAL. Its accounts
# are in board-SERIAL.json once it has been stopped.
plug_vhci_board() {
    vhci_serial=$1
    shift
    run_in_background "board-$vhci_serial" vhci_board --serial "$vhci_serial" --report "board-$vhci_serial.json" "$@"
    wait_for 10 usb_present "$vhci_serial"
}

# plug_acm_gadget SERIAL [OPTION...]: the same board on the kernel's own ACM function.
plug_acm_gadget() {
    gadget_serial=$1
    shift
    mkdir -p $gadget/strings/0x409 $gadget/configs/c.1 $gadget/functions/acm.0
    echo 0x1209 > $gadget/idVendor
    echo 0x6779 > $gadget/idProduct
    echo gyrolog > $gadget/strings/0x409/manufacturer
    echo "gyrolog MPU-9250 on an ACM gadget" > $gadget/strings/0x409/product
    echo "$gadget_serial" > $gadget/strings/0x409/serialnumber
    [ -e $gadget/configs/c.1/acm.0 ] || ln -s $gadget/functions/acm.0 $gadget/configs/c.1/acm.0
    trace_line_state
    run_in_background "board-$gadget_serial" gadget_board --tty /dev/ttyGS0 \
        --line-state /sys/kernel/tracing/trace_pipe --report "board-$gadget_serial.json" "$@"
    echo dummy_udc.0 > $gadget/UDC
    wait_for 10 usb_present "$gadget_serial"
}

unplug_acm_gadget() { echo > $gadget/UDC; }

# The ACM function keeps DTR to itself: its handler of control requests (acm_setup) stores the value, and nothing on
# ttyGS0 tells it. A probe on that handler writes each SET_CONTROL_LINE_STATE to trace_pipe, a line with " value=N".
trace_line_state() {
    [ ! -e /sys/kernel/tracing/events/kprobes/line_state ] || return 0
    echo 'p:line_state usb_f_acm:acm_setup request=+1($arg2):u8 value=+2($arg2):u16' > /sys/kernel/tracing/kprobe_events
    echo 'request == 0x22' > /sys/kernel/tracing/events/kprobes/line_state/filter
    echo 1 > /sys/kernel/tracing/events/kprobes/line_state/enable
}

# native_serial N: the serial number of the Nth native board, 32 digits.
native_serial() { printf 'A1B2C3D40102030405060708%08X' "$1"; }

# plug_native_board PORT N [OPTION...]: the firmware of that port on vhci_hcd, as job board-native. Its accounts are in
# board-native.json once it has been stopped.
plug_native_board() {
    native_port=$1
    native_number=$(native_serial "$2")
    shift 2
    run_in_background board-native "native_${native_port}_on_vhci" --serial "$native_number" --report board-native.json "$@"
    wait_for 20 usb_present "$native_number"
}
