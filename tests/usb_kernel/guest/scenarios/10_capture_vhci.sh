# Half a minute at 1 kHz from the board on vhci_hcd, while usbmon writes its own account of the same bus.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI10
wait_for 10 test -c /dev/ttyACM0
run list gyrolog list --json -
run_in_background usbmon cat /dev/usbmon1
run capture gyrolog capture --device usb:VHCI10 --duration 30s --rate 1000 -o capture.pcapng
wait_for 5 test -c /dev/ttyACM0 && echo back > ttyACM0.state || echo gone > ttyACM0.state
judge capture.pcapng
analyze capture.pcapng
kill "$(cat usbmon.pid)"
finish usbmon
stop board-VHCI10
