# Half a minute at 1 kHz from a port's firmware.
. /test/scenario.sh
. /test/boards.sh

plug_native_board
run list gyrolog list --json -
run capture gyrolog capture --device "usb:$native_serial" --duration 30s --rate 1000 -o capture.pcapng
wait_for 5 terminal_of "$native_serial" && echo back > terminal.state || echo gone > terminal.state
judge capture.pcapng
stop board-native
