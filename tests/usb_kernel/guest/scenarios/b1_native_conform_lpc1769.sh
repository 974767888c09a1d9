# Judged by the rules of the specification, over USB.
. /test/scenario.sh
. /test/boards.sh

plug_native_board lpc1769 177
run conform gyrolog conform --device "usb:$(native_serial 177)"
stop board-native
