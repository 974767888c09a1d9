"""The guest's root file system as a cpio archive: busybox, kernel modules, programs with their shared libraries."""

import re
import stat
import subprocess
from pathlib import Path

from kernel_package import Unavailable, tool

# In the order of loading, each with its parameters. dummy_hcd is told to be a full-speed controller, as the board is.
MODULES = {
    "virtio_pci": "", "9pnet_virtio": "", "9p": "",
    "usbmon": "", "cdc_acm": "", "vhci_hcd": "",
    "dummy_hcd": "is_high_speed=0", "libcomposite": "", "usb_f_acm": "",
}


class Archive:
    """Writer of the "newc" cpio format (kernel documentation: initramfs buffer format). Folders are made as needed."""

    def __init__(self, file):
        self._file = file
        self._folders = set()
        self._inode = 0

    def _entry(self, name, mode, content):
        self._inode += 1
        encoded = name.encode() + b"\0"
        fields = (self._inode, mode, 0, 0, 1, 0, len(content), 0, 0, 0, 0, len(encoded), 0)
        for part in (b"070701" + b"".join(b"%08x" % field for field in fields) + encoded, content):
            self._file.write(part)
            self._file.write(bytes(-self._file.tell() % 4))

    def folder(self, path):
        path = Path(path)
        for folder in [*reversed(path.parents), path]:
            name = str(folder).lstrip("/")
            if name not in ("", ".") and name not in self._folders:
                self._folders.add(name)
                self._entry(name, stat.S_IFDIR | 0o755, b"")

    def file(self, path, content, executable=False):
        self.folder(Path(path).parent)
        self._entry(str(path).lstrip("/"), stat.S_IFREG | (0o755 if executable else 0o644), content)

    def copy(self, source, path, executable=False):
        self.file(path, Path(source).read_bytes(), executable)

    def close(self):
        self._entry("TRAILER!!!", 0, b"")
        self._file.write(bytes(-self._file.tell() % 512))


def shared_libraries(program):
    """What the dynamic linker would load for `program`: paths as it looks them up. Empty for a static program."""
    answer = subprocess.run([tool("ldd"), program], capture_output=True, text=True, check=False)
    if "not found" in answer.stdout:
        raise Unavailable(f"{program} lacks a library: {answer.stdout.strip()}")
    return sorted(set(re.findall(r"(/\S+) \(0x", answer.stdout)))


def busybox():
    """A static busybox: the guest's shell must not depend on libraries."""
    path = tool("busybox")
    if shared_libraries(path):
        raise Unavailable("busybox is not static (package busybox-static)")
    return path


def write(path, kernel, init, programs, files):
    """Writes the archive: `init` becomes /init, `programs` go to /bin with their libraries, `files` maps a path in
    the guest to a path here."""
    with open(path, "wb") as output:
        archive = Archive(output)
        archive.copy(busybox(), "/bin/busybox", executable=True)
        archive.copy(init, "/init", executable=True)
        load = []
        for module, parameters in MODULES.items():
            for file in kernel.module_files([module]):
                name = f"/modules/{Path(file).name}"
                line = f"insmod {name} {parameters if Path(file).stem.replace('-', '_') == module else ''}".rstrip()
                if line not in load:
                    archive.copy(kernel.modules / file, name)
                    load.append(line)
        archive.file("/modules/load", "\n".join(load).encode() + b"\n")
        libraries = set()
        for program in programs:
            archive.copy(program, f"/bin/{Path(program).name}", executable=True)
            libraries.update(shared_libraries(program))
        for library in sorted(libraries):
            archive.copy(library, library, executable=True)
        for guest_path, source in files.items():
            archive.copy(source, guest_path)
        archive.close()
