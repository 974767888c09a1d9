# Half a minute at 1 kHz from the firmware of the LPC55S69's port.
. /test/scenario.sh
. /test/boards.sh

plug_native_board lpcxpresso55s69 160
wait_for 10 test -c /dev/ttyACM0
run list gyrolog list --json -
run capture gyrolog capture --device "usb:$(native_serial 160)" --duration 30s --rate 1000 -o capture.pcapng
wait_for 5 test -c /dev/ttyACM0 && echo back > ttyACM0.state || echo gone > ttyACM0.state
judge capture.pcapng
stop board-native
