# The same at 8 kHz.
. /test/scenario.sh
. /test/boards.sh

plug_native_board lpcxpresso55s69 161
run capture gyrolog capture --device "usb:$(native_serial 161)" --duration 30s --rate 8000 --dlpf 250 -o capture.pcapng
judge capture.pcapng
stop board-native
