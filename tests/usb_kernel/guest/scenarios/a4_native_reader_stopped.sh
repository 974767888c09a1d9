# The reader stands still for two seconds.
. /test/scenario.sh
. /test/boards.sh

plug_native_board
run_in_background capture gyrolog capture --device "usb:$native_serial" --duration 5s --rate 1000 -o capture.pcapng
wait_for 20 capture_is_running capture.pcapng
kill -STOP "$(cat capture.pid)"
sleep 2
kill -CONT "$(cat capture.pid)"
finish capture
judge capture.pcapng
stop board-native
