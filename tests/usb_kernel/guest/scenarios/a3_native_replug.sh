# The cable is pulled out in the middle of a capture and put back; the board keeps its power.
. /test/scenario.sh
. /test/boards.sh

plug_native_board --unplug-after 3 --replug-after 2
run capture gyrolog capture --device "usb:$native_serial" --duration 7s --rate 1000 -o capture.pcapng
judge capture.pcapng
stop board-native
