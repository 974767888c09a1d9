# Judged by the rules of the specification, over USB.
. /test/scenario.sh
. /test/boards.sh

plug_native_board
run conform gyrolog conform --device "usb:$native_serial"
stop board-native
