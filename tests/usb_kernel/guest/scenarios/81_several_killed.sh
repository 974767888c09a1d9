# Three boards on one bus, and the program that captures them is killed, while usbmon writes its own account of the bus.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI83 --seed 1
plug_vhci_board VHCI84 --seed 2
plug_vhci_board VHCI85 --seed 3
run_in_background usbmon cat /dev/usbmon1
run_in_background pace sh -c 'while :; do cat /proc/uptime; sleep 0.05; done'
run_in_background capture gyrolog capture --device 'usb:*' --duration 60s --rate 8000 --dlpf 250 -o night.pcapng
for serial in VHCI83 VHCI84 VHCI85; do wait_for 30 capture_is_running night-$serial.pcapng; done
sleep 4
kill -KILL "$(cat capture.pid)"
finish capture
kill "$(cat pace.pid)"
finish pace
sleep 1
kill "$(cat usbmon.pid)"
finish usbmon
for serial in VHCI83 VHCI84 VHCI85; do
    judge night-$serial.pcapng
    stop board-$serial
done
