"""What the bus carries between host and device models, and the packets' toggles (USB 2.0, 8.6)."""

ACK, NAK, STALL = "ack", "nak", "stall"
DATA0, DATA1 = 0, 1
PACKET_BYTES = 64  # of control and bulk endpoints at full speed


class Packet(bytes):
    """Data with its toggle."""

    def __new__(cls, toggle, data):
        packet = super().__new__(cls, data)
        packet.toggle = toggle
        return packet
