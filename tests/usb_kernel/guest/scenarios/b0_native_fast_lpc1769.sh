# Half a minute at 8 kHz from the firmware of the LPC1769's port.
. /test/scenario.sh
. /test/boards.sh

plug_native_board lpc1769 176
run list gyrolog list --json -
run capture gyrolog capture --device "usb:$(native_serial 176)" --duration 30s --rate 8000 --dlpf 250 -o capture.pcapng
judge capture.pcapng
stop board-native
