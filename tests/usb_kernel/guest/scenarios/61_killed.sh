# Killed without a chance to clean up: what was captured is intact, and the board can be used again at once.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI61
run_in_background killed gyrolog capture --device usb:VHCI61 --duration 60s --rate 1000 -o killed.pcapng
wait_for 20 capture_is_running killed.pcapng
sleep 3
kill -KILL "$(cat killed.pid)"
finish killed
judge killed.pcapng
run capture gyrolog capture --device usb:VHCI61 --duration 3s --rate 1000 -o capture.pcapng
judge capture.pcapng
stop board-VHCI61
