# The bus is reset in the middle of a capture, wherever in a frame that is.
. /test/scenario.sh
. /test/boards.sh

plug_native_board --reset-after 3
run capture gyrolog capture --device "usb:$native_serial" --duration 12s --rate 8000 --dlpf 250 -o capture.pcapng
judge capture.pcapng
stop board-native
