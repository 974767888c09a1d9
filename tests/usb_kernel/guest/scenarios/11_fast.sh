# The fastest rate with a filter: 8 kHz.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI11 --fixed-kind-endpoints
run capture gyrolog capture --device usb:VHCI11 --duration 5s --rate 8000 --dlpf 250 -o capture.pcapng
judge capture.pcapng
stop board-VHCI11
