# Judged by the rules of the specification, over USB.
. /test/scenario.sh
. /test/boards.sh

plug_native_board lpcxpresso55s69 162
run conform gyrolog conform --device "usb:$(native_serial 162)"
stop board-native
