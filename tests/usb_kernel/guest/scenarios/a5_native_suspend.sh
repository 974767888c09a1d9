# The bus idles for a second in the middle of a capture: the board ends its stream and begins another.
. /test/scenario.sh
. /test/boards.sh

plug_native_board --suspend-after 3 --resume-after 1
run capture gyrolog capture --device "usb:$native_serial" --duration 6s --rate 1000 -o capture.pcapng
judge capture.pcapng
stop board-native
