# The reader stands still for two seconds: the kernel holds the transfers that are already submitted, the board the rest.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI70
run_in_background capture gyrolog capture --device usb:VHCI70 --duration 10s --rate 1000 -o capture.pcapng
wait_for 20 capture_is_running capture.pcapng
kill -STOP "$(cat capture.pid)"
sleep 2
kill -CONT "$(cat capture.pid)"
finish capture
judge capture.pcapng
stop board-VHCI70
