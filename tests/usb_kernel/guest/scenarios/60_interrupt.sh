# A signal that ends the capture, and what a second program may do meanwhile.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI60
wait_for 10 test -c /dev/ttyACM0
run_in_background capture gyrolog capture --device usb:VHCI60 --duration 60s --rate 1000 -o capture.pcapng
wait_for 20 capture_is_running capture.pcapng
run second gyrolog capture --device usb:VHCI60 --duration 5s -o second.pcapng
sleep 2
stop capture
wait_for 5 test -c /dev/ttyACM0 && echo back > ttyACM0.state || echo gone > ttyACM0.state
judge capture.pcapng
stop board-VHCI60
