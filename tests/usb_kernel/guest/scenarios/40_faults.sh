# Transfers that fail while the board streams: a stall, a packet too long, a checksum error. The board has the bytes
# still, so nothing may be missing.
. /test/scenario.sh
. /test/boards.sh

plug_vhci_board VHCI40 --fault stall@2 --fault babble@4 --fault crc@6
run capture gyrolog capture --device usb:VHCI40 --duration 10s --rate 1000 -o capture.pcapng
judge capture.pcapng
stop board-VHCI40
