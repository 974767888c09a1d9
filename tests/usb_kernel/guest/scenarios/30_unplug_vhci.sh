# Pulled out in the middle of a capture.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI30 --unplug-after 6
run capture gyrolog capture --on-unplug exit --device usb:VHCI30 --duration 60s --rate 1000 -o capture.pcapng
judge capture.pcapng
analyze capture.pcapng
stop board-VHCI30
