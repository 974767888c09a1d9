# Through the kernel's cdc_acm driver: DTR and bytes of a terminal line.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI50
wait_for 10 test -c /dev/ttyACM0
run capture gyrolog capture --device tty:/dev/ttyACM0 --duration 10s --rate 1000 -o capture.pcapng
judge capture.pcapng
stop board-VHCI50
