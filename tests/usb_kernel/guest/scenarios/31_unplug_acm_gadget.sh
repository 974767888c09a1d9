# The gadget taken off its controller in the middle of a capture: libusb sees transfers fail before the device goes.
. /test/scenario.sh
. /test/boards.sh

plug_acm_gadget GADGET31
run_in_background capture gyrolog capture --on-unplug exit --device usb:GADGET31 --duration 60s --rate 1000 -o capture.pcapng
wait_for 20 capture_is_running capture.pcapng
sleep 3
unplug_acm_gadget
finish capture
judge capture.pcapng
analyze capture.pcapng
stop board-GADGET31
