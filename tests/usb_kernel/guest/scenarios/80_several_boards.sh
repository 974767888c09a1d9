# Three boards on one bus, captured at the same time by one program at the fastest rate with a filter.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI80 --seed 1
plug_vhci_board VHCI81 --seed 2
plug_vhci_board VHCI82 --seed 3
run list gyrolog list --json -
run capture gyrolog capture --device 'usb:*' --duration 8s --rate 8000 --dlpf 250 -o night.pcapng
for serial in VHCI80 VHCI81 VHCI82; do
    judge night-$serial.pcapng
    stop board-$serial
done
