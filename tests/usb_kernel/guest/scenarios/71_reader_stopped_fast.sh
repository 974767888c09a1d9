# The same at the fastest rate with a filter.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI71
run_in_background capture gyrolog capture --device usb:VHCI71 --duration 8s --rate 8000 --dlpf 250 -o capture.pcapng
wait_for 20 capture_is_running capture.pcapng
kill -STOP "$(cat capture.pid)"
sleep 2
kill -CONT "$(cat capture.pid)"
finish capture
judge capture.pcapng
stop board-VHCI71
