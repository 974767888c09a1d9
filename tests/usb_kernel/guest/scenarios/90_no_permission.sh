# A user who may not open the device, and no device at all.
. /test/scenario.sh
. /test/boards.sh

run none gyrolog capture --device usb: --duration 5s -o none.pcapng
plug_vhci_board VHCI90
mkdir -p user
chmod 777 user
chmod 600 /dev/bus/usb/*/*
(cd user && run denied su -s /bin/sh nobody -c "gyrolog capture --device usb: --duration 5s -o denied.pcapng" &&
    run list su -s /bin/sh nobody -c "gyrolog list --json -")
cp user/* .
stop board-VHCI90
