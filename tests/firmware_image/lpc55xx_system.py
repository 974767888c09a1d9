"""The LPC55S69's clocks, power and resets: SYSCON, PMC, ANACTRL and the flash controller as far as this project's image
touches them. What the knowledge is from, lpc55xx.py says."""

from machine import WAIT_FOR_OSCILLATOR_TICKS, Registers, Violation, field

CRYSTAL_HZ = 16_000_000
FRO_HF_HZ, FRO_12M_HZ, FRO_1M_HZ = 96_000_000, 12_000_000, 1_000_000
OSCILLATOR_TICKS = LOCK_TICKS = 25_000
# Highest core clock with 0, 1, 2... wait states of the flash
FLASH_MHZ = (11, 22, 33, 44, 55, 66, 77, 88, 100, 115, 130, 150)
# PDRUNCFG0: 1 is off
FRO_1M, XTAL32M, PLL1, USB0_PHY, LDO_XO32M, TRNG = 4, 8, 10, 11, 20, 22
OFF_AFTER_RESET = 0x00DEFFC4
DIVIDER_RESET, DIVIDER_HALT = 1 << 29, 1 << 30
NO_CLOCK = 7


class Syscon(Registers):
    names = {**{0x100 + 4 * n: f"PRESETCTRL{n}" for n in range(3)}, **{0x120 + 4 * n: f"PRESETCTRLSET{n}" for n in range(3)},
             **{0x140 + 4 * n: f"PRESETCTRLCLR{n}" for n in range(3)}, **{0x200 + 4 * n: f"AHBCLKCTRL{n}" for n in range(3)},
             **{0x220 + 4 * n: f"AHBCLKCTRLSET{n}" for n in range(3)},
             **{0x240 + 4 * n: f"AHBCLKCTRLCLR{n}" for n in range(3)}, 0x26C: "CTIMERCLKSEL0", 0x280: "MAINCLKSELA",
             0x284: "MAINCLKSELB", 0x294: "PLL1CLKSEL", 0x2A8: "USB0CLKSEL", 0x2D0: "HSLSPICLKSEL", 0x380: "AHBCLKDIV",
             0x38C: "WDTCLKDIV", 0x398: "USB0CLKDIV", 0x400: "FMCCR", 0x560: "PLL1CTRL", 0x564: "PLL1STAT",
             0x568: "PLL1NDEC", 0x56C: "PLL1MDEC", 0x570: "PLL1PDEC", 0xA18: "CLOCK_CTRL"}
    CLOCK_IN, CLOCK_1M = 5, 6  # CLOCK_CTRL

    def __init__(self, pmc, anactrl):
        super().__init__()
        self.pmc, self.anactrl = pmc, anactrl
        self.value = {0x26C: NO_CLOCK, 0x280: 3, 0x294: NO_CLOCK, 0x2A8: NO_CLOCK, 0x2D0: NO_CLOCK, 0x380: 1,
                      0x38C: DIVIDER_HALT, 0x398: DIVIDER_HALT, 0x400: 0x4000, 0xA18: 1 << self.CLOCK_1M}
        self.ratio = {"N": 0, "M": 0, "P": 0}
        self.to_reset = {}  # (register, bit): peripheral
        self.hz = {}  # what pll_hz and main_hz gave since clocks or power were changed last

    def read(self, offset):
        self.machine.wait(WAIT_FOR_OSCILLATOR_TICKS)
        if self.names.get(offset) == "PLL1STAT":
            return int(self.pll_locked())
        return super().read(offset)

    def write(self, offset, value):
        self.known(offset)
        name = self.names[offset]
        self.hz.clear()
        if name.startswith(("PRESETCTRLSET", "PRESETCTRLCLR", "AHBCLKCTRLSET", "AHBCLKCTRLCLR")):
            self.change_bits(offset, name, value)
        elif name in ("PLL1NDEC", "PLL1MDEC", "PLL1PDEC"):
            letter, request = {"PLL1NDEC": ("N", 8), "PLL1MDEC": ("M", 16), "PLL1PDEC": ("P", 5)}[name]
            super().write(offset, value)
            if value >> request & 1:
                self.ratio[letter] = field(value, 0, request)
        elif name.startswith(("PRESETCTRL", "AHBCLKCTRL")) or name == "PLL1STAT":
            raise Violation(f"SYSCON: {name} written")
        else:
            super().write(offset, value & ~DIVIDER_RESET if "DIV" in name else value)
        self.check_core()

    def change_bits(self, offset, name, value):
        target = offset - (0x20 if "SET" in name[9:] else 0x40)
        old = self.value.get(target, 0)
        self.value[target] = old | value if "SET" in name[9:] else old & ~value
        if name.startswith("PRESETCTRLSET"):
            for (register, bit), peripheral in self.to_reset.items():
                if register == int(name[-1]) and value >> bit & 1:
                    peripheral.reset()

    def running(self, gate, name):
        register, bit = gate
        if not self[f"AHBCLKCTRL{register}"] >> bit & 1:
            raise Violation(f"{name} touched without its clock")
        if self[f"PRESETCTRL{register}"] >> bit & 1:
            raise Violation(f"{name} touched while it is held in reset")

    # -------------------------------------------------------------------------------------------------------- clocks

    def crystal_hz(self):
        return CRYSTAL_HZ if self["CLOCK_CTRL"] >> self.CLOCK_IN & 1 and self.anactrl.crystal_out() else None

    def pll_input_hz(self):
        return {0: FRO_12M_HZ, 1: self.crystal_hz()}.get(self["PLL1CLKSEL"])

    def fcco_hz(self):
        source = self.pll_input_hz()
        if source is None or not all(self.ratio.values()):
            return None
        return source // self.ratio["N"] * self.ratio["M"]

    def pll_locked(self):
        since = self.pmc.on_since(PLL1)
        return (since is not None and self.fcco_hz() is not None and self.machine.now >= since + LOCK_TICKS and
                not self.anactrl.pll_never_locks)

    def pll_hz(self):
        """Complains where what comes out is no clock."""
        if "pll" not in self.hz:
            self.hz["pll"] = self.checked_pll_hz()
        return self.hz["pll"]

    def checked_pll_hz(self):
        if not self.pll_locked():
            raise Violation("PLL1 is used before it has locked")
        fcco, m, control = self.fcco_hz(), self.ratio["M"], self["PLL1CTRL"]
        if not 275_000_000 <= fcco <= 550_000_000:
            raise Violation(f"PLL1: Fcco is {fcco} Hz")
        if not control >> 21 & 1 or control & 0x198000:
            raise Violation(f"PLL1CTRL is {control:08x}: no output, or one past a divider")
        wanted = (2 * (m // 4) + 3, m // 4 + 1)
        if (field(control, 4, 6), field(control, 10, 5)) != wanted:
            raise Violation(f"PLL1: the bandwidth for M = {m} is SELI, SELP = {wanted}")
        return fcco // (2 * self.ratio["P"])

    def main_hz(self):
        if "main" not in self.hz:
            self.hz["main"] = self.selected_main_hz()
        return self.hz["main"]

    def selected_main_hz(self):
        source = self["MAINCLKSELB"]
        if source == 2:
            return self.pll_hz()
        if source == 0:
            return {0: FRO_12M_HZ, 1: self.crystal_hz(), 2: FRO_1M_HZ, 3: FRO_HF_HZ}[self["MAINCLKSELA"]]
        raise Violation(f"the main clock's source {source}")

    def check_core(self):
        core_hz = self.main_hz() // (field(self["AHBCLKDIV"], 0, 8) + 1)
        waits = min(field(self["FMCCR"], 12, 4), self.flash.wait_states)
        if core_hz > 1_000_000 * FLASH_MHZ[min(waits, len(FLASH_MHZ) - 1)]:
            raise Violation(f"core at {core_hz} Hz with {waits} wait states of the flash")
        return core_hz

    def selected_hz(self, register):
        """Of a peripheral whose selector's 0 is the main clock."""
        if self[register] != 0:
            raise Violation(f"{register} is {self[register]}")
        return self.main_hz()

    def divided(self, source_hz, register, bits):
        if self[register] & DIVIDER_HALT:
            raise Violation(f"{register} is halted")
        return source_hz // (field(self[register], 0, bits) + 1)

    def usb_hz(self):
        if self["USB0CLKSEL"] != 5:
            raise Violation(f"USB0CLKSEL is {self['USB0CLKSEL']}: not the crystal's PLL")
        return self.divided(self.pll_hz(), "USB0CLKDIV", 8)

    def watchdog_hz(self):
        if self.pmc.on_since(FRO_1M) is None or not self["CLOCK_CTRL"] >> self.CLOCK_1M & 1:
            raise Violation("the watchdog's oscillator is off")
        return self.divided(FRO_1M_HZ, "WDTCLKDIV", 6)


class Pmc(Registers):
    names = {0x10: "DCDC0", 0x14: "DCDC1", 0x1C: "LDOPMU", 0x84: "AOREG1", 0xB8: "PDRUNCFG0", 0xC0: "PDRUNCFGSET0",
             0xC8: "PDRUNCFGCLR0"}

    def __init__(self, cause):
        super().__init__()
        self.on_change = lambda: None
        self.value = {0x84: cause, 0xB8: OFF_AFTER_RESET}
        self.since = {bit: 0 for bit in range(32) if not self["PDRUNCFG0"] >> bit & 1}

    def write(self, offset, value):
        self.known(offset)
        name = self.names[offset]
        if name.startswith("PDRUNCFG"):
            old = self["PDRUNCFG0"]
            new = {"PDRUNCFGSET0": old | value, "PDRUNCFGCLR0": old & ~value}.get(name, value)
            self.value[0xB8] = new
            self.on_change()
            for bit in range(32):
                if new >> bit & 1:
                    self.since.pop(bit, None)
                elif old >> bit & 1:
                    self.since[bit] = self.machine.now
        else:
            super().write(offset, value)

    def on_since(self, bit):
        return self.since.get(bit)


class Anactrl(Registers):
    names = {0x10: "FRO192M_CTRL", 0x20: "XO32M_CTRL", 0x24: "XO32M_STATUS", 0xB0: "LDO_XO32M"}
    CLOCK_OUT = 24  # XO32M_CTRL

    def __init__(self, pmc):
        super().__init__()
        self.pmc = pmc
        self.on_change = lambda: None
        self.crystal_never_starts = self.pll_never_locks = False

    def crystal_runs(self):
        since = [self.pmc.on_since(bit) for bit in (XTAL32M, LDO_XO32M)]
        return (None not in since and self.machine.now >= max(since) + OSCILLATOR_TICKS and
                not self.crystal_never_starts)

    def crystal_out(self):
        return self.crystal_runs() and self["XO32M_CTRL"] >> self.CLOCK_OUT & 1

    def read(self, offset):
        self.machine.wait(WAIT_FOR_OSCILLATOR_TICKS)
        if self.names.get(offset) == "XO32M_STATUS":
            return int(self.crystal_runs())
        return super().read(offset)

    def write(self, offset, value):
        super().write(offset, value)
        self.on_change()


class FlashController(Registers):
    """Whose one command here sets the wait states that the array needs."""

    names = {0x00: "CMD", 0x80: "DATAW0", 0xFE0: "INT_STATUS", 0xFE8: "INT_CLR_STATUS"}
    SET_READ_MODE, DONE, PREFETCH = 2, 1 << 2, 5  # CMD, INT_STATUS, FMCCR

    def __init__(self, syscon):
        super().__init__()
        self.syscon = syscon
        self.wait_states = 4

    def write(self, offset, value):
        self.known(offset)
        name = self.names[offset]
        if name == "CMD":
            if value != self.SET_READ_MODE:
                raise Violation(f"flash command {value}")
            if self.syscon["FMCCR"] >> self.PREFETCH & 1:
                raise Violation("a flash command while prefetch is on")
            self.wait_states = field(self["DATAW0"], 0, 4)
            self.value[0xFE0] = self.DONE
        elif name == "INT_CLR_STATUS":
            self.value[0xFE0] = self["INT_STATUS"] & ~value
        else:
            super().write(offset, value)
