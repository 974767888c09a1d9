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

# plug_native_board [OPTION...]: the firmware of the port that the scenario's name ends in, on vhci_hcd, as job
# board-native, until cdc_acm has it. Its serial number is in native_serial, another in each scenario; its accounts are in
# board-native.json once it has been stopped.
plug_native_board() {
    native_port=$(basename "$0" .sh)
    native_port=${native_port##*_}
    native_serial=$(basename "$0" | md5sum | cut -c 1-32 | tr a-f A-F)
    run_in_background board-native "native_${native_port}_on_vhci" --serial "$native_serial" --report board-native.json "$@"
    wait_for 20 terminal_of "$native_serial"
}
