# The same at 8 kHz.
. /test/scenario.sh
. /test/boards.sh

plug_native_board
run capture gyrolog capture --device "usb:$native_serial" --duration 30s --rate 8000 --dlpf 250 -o capture.pcapng
judge capture.pcapng
stop board-native
