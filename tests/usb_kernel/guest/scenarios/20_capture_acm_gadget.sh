# The same from the kernel's own ACM function: a USB device that is not ours.
. /test/scenario.sh
. /test/boards.sh

plug_acm_gadget GADGET20
wait_for 10 test -c /dev/ttyACM0
run capture gyrolog capture --device usb:GADGET20 --duration 30s --rate 1000 -o capture.pcapng
wait_for 5 test -c /dev/ttyACM0 && echo back > ttyACM0.state || echo gone > ttyACM0.state
judge capture.pcapng
stop board-GADGET20
unplug_acm_gadget
