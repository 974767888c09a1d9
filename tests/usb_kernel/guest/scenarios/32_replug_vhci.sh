# Pulled out in the middle of a capture, and put back: the board has booted, and has another address.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI32 --unplug-after 6 --replug-after 3
run capture gyrolog capture --device usb:VHCI32 --duration 20s --rate 1000 -o capture.pcapng
judge capture.pcapng
analyze capture.pcapng
stop board-VHCI32
