"""A Cortex-M that runs an image as it would be flashed: memory, registers of peripherals as Python objects, interrupts
with their priorities. The instructions are Unicorn's, whose M-class core is a Cortex-M33 (release 2.0.1 takes no other,
whatever is asked for): an image for a Cortex-M3 runs on it too, but an instruction that only the Cortex-M33 has would not
be noticed. Time is counted in ticks of the core clock, one for each byte of code that runs, which is about what flash and
pipeline make of it."""

import random
import struct

from unicorn import UC_ARCH_ARM, UC_HOOK_BLOCK, UC_HOOK_CODE, UC_HOOK_MEM_UNMAPPED, UC_MODE_MCLASS, UC_MODE_THUMB, Uc, UcError
from unicorn import arm_const as arm

PAGE = 0x1000
SYSTEM_SPACE = 0xE000E000
RETURN_STUB = 0x1FFF0000  # where a handler's return address points; no memory of the part
IT_STATE = 0x0600FC00     # of XPSR: inside a conditional block
THREAD = 256              # priority without an interrupt
SLICE_TICKS = (40, 400)   # an interrupt is looked for at random moments
WAITING_READS = 20        # of one register, one after the other: the image waits for it
WAIT_FOR_TIME_TICKS = 1000       # let pass at once
WAIT_FOR_OSCILLATOR_TICKS = 10_000
REGISTERS = [arm.UC_ARM_REG_R0 + n for n in range(13)] + [arm.UC_ARM_REG_LR, arm.UC_ARM_REG_SP, arm.UC_ARM_REG_PC,
                                                          arm.UC_ARM_REG_XPSR]


class Violation(Exception):
    """The image did what the part forbids."""


def field(value, low, bits):
    return value >> low & ((1 << bits) - 1)


class Registers:
    """A block of registers that only remembers; a peripheral derives from it."""

    names = {}  # offset: name
    size = PAGE

    def __init__(self):
        self.value = {}
        self.offset_of = {name: offset for offset, name in self.names.items()}

    def read(self, offset):
        self.known(offset)
        return self.value.get(offset, 0)

    def write(self, offset, value):
        self.known(offset)
        self.value[offset] = value

    def known(self, offset):
        if offset not in self.names:
            raise Violation(f"{type(self).__name__} has no register at {offset:03x}")

    def __getitem__(self, name):
        return self.value.get(self.offset_of[name], 0)

    def advance(self):
        """What happened until now."""

    def next_event(self):
        """The tick of what happens next by itself, or None."""
        return None


class Interrupts(Registers):
    """NVIC and what else of the system space an image touches."""

    def __init__(self):
        super().__init__()
        self.enabled = 0
        self.pending = 0
        self.priority = [0] * 64
        self.lines = {}  # number: whether it asks now
        self.held = set()  # asks for what its handler has just been called for, and does not pend again by it

    def known(self, offset):
        pass

    def read(self, offset):
        return {0x100: self.enabled, 0x180: self.enabled, 0x200: self.pending}.get(offset, 0)

    def write(self, offset, value):
        if offset == 0x100:
            self.enabled |= value
        elif offset == 0x180:
            self.enabled &= ~value
        elif offset == 0x200:
            self.pending |= value
        elif offset == 0x280:
            self.pending &= ~value
        elif 0x400 <= offset < 0x440:
            self.priority[offset - 0x400] = value & 0xFF

    def look(self, above):
        """The number of the interrupt that is more urgent than `above`, or None."""
        for number, asks in self.lines.items():
            if not asks():
                self.held.discard(number)
            elif number not in self.held:
                self.pending |= 1 << number
        ready = self.pending & self.enabled
        if not ready:
            return None
        priority, number = min((self.priority[n], n) for n in range(64) if ready >> n & 1)
        return number if priority < above else None

    def take(self, number):
        self.pending &= ~(1 << number)
        self.held.add(number)


class Machine:
    """`memory` is a list of (address, bytes); `peripherals` of (address, Registers)."""

    def __init__(self, image, memory, peripherals, core_hz, seed):
        self.now = 0
        self.core_hz = core_hz
        self.random = random.Random(seed)
        self.interrupts = Interrupts()
        for _, peripheral in peripherals:
            peripheral.machine = self
        # The others do nothing by themselves.
        self.timed = [peripheral for _, peripheral in peripherals if type(peripheral).advance is not Registers.advance or
                      type(peripheral).next_event is not Registers.next_event]
        self.last_access, self.reads = None, 0
        self.failure = None
        self.active = []  # (priority, number, registers to go on with), outermost first
        self.returned = False
        self.slice = 0
        self.latency_ticks = 0  # an interrupt waits at least as long; a test makes the core slow by it
        self.asked_since = None
        self.uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        self.uc.ctl_set_cpu_model(arm.UC_CPU_ARM_CORTEX_M33)
        size = -(-len(image) // PAGE) * PAGE
        self.uc.mem_map(0, size, 5)
        self.uc.mem_write(0, image)
        for address, content in memory:
            self.uc.mem_map(address, len(content))
            self.uc.mem_write(address, content)
        for address, peripheral in [*peripherals, (SYSTEM_SPACE, self.interrupts)]:
            self.map(address, peripheral)
        self.uc.mem_map(RETURN_STUB, PAGE)
        self.uc.mem_write(RETURN_STUB, bytes.fromhex("fee7"))
        self.uc.hook_add(UC_HOOK_CODE, self.on_return, None, RETURN_STUB, RETURN_STUB + 1)
        self.uc.hook_add(UC_HOOK_BLOCK, self.on_block)
        self.uc.hook_add(UC_HOOK_MEM_UNMAPPED, self.on_unmapped)
        stack, start = struct.unpack_from("<2I", image)
        self.uc.reg_write(arm.UC_ARM_REG_SP, stack)
        self.pc = start

    def map(self, address, peripheral):
        def read(_, offset, size, __):
            return self.guarded(lambda: self.read_register(peripheral, offset, size))

        def write(_, offset, size, value, __):
            self.guarded(lambda: self.write_register(peripheral, offset, size, value))

        self.uc.mmio_map(address, peripheral.size, read, None, write, None)

    def read_register(self, peripheral, offset, size):
        self.reads = self.reads + 1 if (peripheral, offset) == self.last_access else 0
        self.last_access = peripheral, offset
        self.advance()
        value = peripheral.read(offset if peripheral is self.interrupts else offset & ~3)
        return value & ((1 << 8 * size) - 1)

    def write_register(self, peripheral, offset, size, value):
        if size != 4 and peripheral is not self.interrupts:
            raise Violation(f"{type(peripheral).__name__}: {size} bytes written at {offset:03x}")
        self.last_access = None
        self.advance()
        peripheral.write(offset, value)

    def guarded(self, action):
        if self.failure is None:
            try:
                return action() or 0
            except Exception as error:  # Unicorn would swallow it
                self.failure = error
        self.uc.emu_stop()
        return 0

    def call_at(self, address, action):
        """Code of the part's own at `address`: runs `action` and returns."""
        self.uc.mem_write(address, bytes.fromhex("7047"))
        self.uc.hook_add(UC_HOOK_CODE, lambda *_: self.guarded(action), None, address, address + 1)

    def on_return(self, *_):
        self.returned = True
        self.uc.emu_stop()

    def on_block(self, _, address, size, __):
        if self.slice < 0:
            # Before the block is run. Unicorn's own PC is behind by then.
            self.pc = address
            self.uc.emu_stop()
            return
        self.now += size
        self.slice -= size

    def on_unmapped(self, _, __, address, *___):
        self.failure = self.failure or Violation(f"nothing is at {address:08x}")
        return False

    def advance(self):
        for peripheral in self.timed:
            peripheral.advance()

    def pass_time(self, most_ticks):
        """An image that only waits need not be run for it: on to the next event, unless an interrupt is to be served."""
        self.slice = -1  # looked for at once
        if self.interrupts.look(self.priority()) is not None:
            return
        events = [event for event in (peripheral.next_event() for peripheral in self.timed) if event is not None]
        self.now = max(self.now, min([self.now + most_ticks, *events]))

    def priority(self):
        return self.active[-1][0] if self.active else THREAD

    def wait(self, step_ticks):
        """Lets time pass where the image reads nothing but the register that it reads now."""
        if self.reads > WAITING_READS:
            self.pass_time(step_ticks)
            self.advance()

    def word(self, address):
        return struct.unpack("<I", self.uc.mem_read(address, 4))[0]

    def step(self):
        self.advance()
        self.take_interrupt()
        self.slice = self.random.randint(*SLICE_TICKS)
        try:
            self.uc.emu_start(self.pc | 1, 0xFFFFFFFE)
        except UcError as error:
            if isinstance(self.failure, Violation):
                raise self.failure from error
            raise Violation(f"at {self.uc.reg_read(arm.UC_ARM_REG_PC):08x}: {error}") from self.failure
        if self.failure:
            raise self.failure
        if self.returned:
            self.return_from_interrupt()

    def take_interrupt(self):
        if self.uc.reg_read(arm.UC_ARM_REG_PRIMASK) & 1 or self.uc.reg_read(arm.UC_ARM_REG_XPSR) & IT_STATE:
            return
        number = self.interrupts.look(self.priority())
        if number is None:
            self.asked_since = None
            return
        if self.asked_since is None:
            self.asked_since = self.now
        if self.now - self.asked_since < self.latency_ticks:
            return
        self.asked_since = None
        self.interrupts.take(number)
        kept = [self.uc.reg_read(register) for register in REGISTERS]
        kept[REGISTERS.index(arm.UC_ARM_REG_PC)] = self.pc
        self.active.append((self.interrupts.priority[number], number, kept))
        frame = (self.uc.reg_read(arm.UC_ARM_REG_SP) - 32) & ~7
        self.uc.mem_write(frame, struct.pack("<8I", *kept[0:4], kept[12], kept[13], self.pc, kept[-1]))
        self.uc.reg_write(arm.UC_ARM_REG_SP, frame)
        self.uc.reg_write(arm.UC_ARM_REG_LR, RETURN_STUB | 1)
        self.pc = self.word(4 * (16 + number))
        if self.pc == 0:
            raise Violation(f"interrupt {number} has no handler")

    def return_from_interrupt(self):
        self.returned = False
        _, number, kept = self.active.pop()
        self.interrupts.held.discard(number)
        for register, value in zip(REGISTERS, kept):
            self.uc.reg_write(register, value)
        self.pc = kept[REGISTERS.index(arm.UC_ARM_REG_PC)]

    def run_until(self, condition, limit_ticks):
        """Whether `condition` has come to hold within the limit."""
        end = self.now + limit_ticks
        while not condition():
            if self.now >= end:
                return False
            self.step()
        return True
