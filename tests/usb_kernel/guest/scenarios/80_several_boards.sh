# Three boards on one bus, two captured at the same time.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI80 --seed 1
plug_vhci_board VHCI81 --seed 2
plug_vhci_board VHCI82 --seed 3
run list gyrolog list --json -
run_in_background first gyrolog capture --device usb:VHCI80 --duration 8s --rate 1000 -o first.pcapng
run_in_background second gyrolog capture --device usb:VHCI82 --duration 8s --rate 500 -o second.pcapng
finish first
finish second
judge first.pcapng
judge second.pcapng
for serial in VHCI80 VHCI81 VHCI82; do stop board-$serial; done
