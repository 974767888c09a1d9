# The cable is pulled out in the middle of a capture and put back; the board keeps its power.
. /test/scenario.sh
. /test/boards.sh

plug_native_board lpcxpresso55s69 163 --unplug-after 6 --replug-after 3
run capture gyrolog capture --device "usb:$(native_serial 163)" --duration 20s --rate 1000 -o capture.pcapng
judge capture.pcapng
stop board-native
