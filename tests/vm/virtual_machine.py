#!/usr/bin/python3
"""Runs a program under Debian's own Linux kernel in a small virtual machine.

The machine has the kernel's HID stack (uhid, hidraw, hid-generic), a busybox and the program with
its libraries, nothing else. It lives in virtual time: 1 ms in it is 1 ms for it, however busy this
computer is. As a command it behaves like the program: its output, its exit status; 77 and the
reason on stderr where there can be no machine.
"""

from __future__ import annotations

import argparse
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CACHE = Path(os.environ.get("LIMPID_VM_CACHE", ROOT / "build/vm"))
KERNEL_PACKAGE = "linux-image-cloud-amd64"
MODULES = ("uhid", "hid-generic", "evdev")
SKIPPED = 77
TAIL = 2000  # characters of what a failed machine said last
TOOLS = {  # program: its package
    "qemu-system-x86_64": "qemu-system-x86",
    "busybox": "busybox-static",
    "depmod": "kmod",
    "cpio": "cpio",
    "dpkg-deb": "dpkg",
    "ldd": "libc-bin",
    "apt-get": "apt",
}
SEARCH_PATH = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])

# Kernel messages go to the first serial port, what the program says alone to the second.
INIT = """#!/bin/busybox sh
/bin/busybox --install -s /bin
mount -t devtmpfs dev /dev
mount -t proc proc /proc
mount -t sysfs sys /sys
mkdir -p /dev/shm
mount -t tmpfs tmp /dev/shm
chmod 1777 /tmp
exec >/dev/ttyS0 2>&1
ip link set lo up
for module in {modules}; do insmod /modules/$module || exit; done
stty -F /dev/ttyS1 115200 raw -echo
cd /guest
env {environment} {command} </dev/null >/dev/ttyS1 2>&1
echo "guest status $?"
reboot -f
"""


class CannotRun(Exception):
    """There can be no virtual machine here; the message says why, for people."""


class GuestFailed(Exception):
    """The machine did not come to a verdict; the message ends with what it last said."""


@dataclass(frozen=True)
class Kernel:
    image: Path
    modules: tuple[Path, ...]  # in the order in which they have to be loaded


@dataclass(frozen=True)
class Result:
    status: int  # of the program; 128 + the signal's number if one ended it
    out: str  # stdout and stderr of the program
    console: str  # what the kernel said


@dataclass(frozen=True)
class Guest:
    """A program to be run in a machine. Files and folders go to their place in the machine, which
    is relative to /guest, the working directory, unless it begins with a slash. The libraries of
    files that are programs come with them; the busybox commands are there anyway."""

    program: Path
    arguments: Sequence[str] = ()
    files: Mapping[str, Path] = field(default_factory=dict)
    environment: Mapping[str, str] = field(default_factory=dict)
    memory: int = 512  # [MiB]
    timeout: float = 120  # on this computer's clock [s]
    cache: Path = CACHE

    def run(self) -> Result:
        """Starts the machine, waits for the program's end. Throws CannotRun or GuestFailed."""
        kernel = debian_kernel(self.cache)
        with tempfile.TemporaryDirectory(prefix="limpid-vm-") as folder:
            initramfs = pack(self._tree(kernel, Path(folder) / "tree"), Path(folder) / "initramfs")
            return self._boot(kernel, initramfs, Path(folder) / "console")

    def _tree(self, kernel: Kernel, tree: Path) -> Path:
        for name in ("bin", "dev", "proc", "sys", "tmp", "modules", "guest"):
            (tree / name).mkdir(parents=True)
        for module in kernel.modules:
            shutil.copy(module, tree / "modules")
        shutil.copy(tool("busybox"), tree / "bin/busybox")
        shutil.copy(self.program, tree / "guest" / self.program.name)
        programs = [Path(tool("busybox")), self.program, *filter(is_program, self.files.values())]
        folders = copy_libraries(programs, tree)
        for place, source in self.files.items():
            target = tree / place.lstrip("/") if place.startswith("/") else tree / "guest" / place
            target.parent.mkdir(parents=True, exist_ok=True)
            (shutil.copytree if source.is_dir() else shutil.copy)(source, target)
        environment = {
            "PATH": "/bin",
            "HOME": "/tmp",
            "LD_LIBRARY_PATH": ":".join(folders),
            **self.environment,
        }
        init = tree / "init"
        init.write_text(
            INIT.format(
                modules=" ".join(module.name for module in kernel.modules),
                environment=shlex.join(f"{key}={value}" for key, value in environment.items()),
                command=shlex.join([f"./{self.program.name}", *self.arguments]),
            )
        )
        init.chmod(0o755)
        return tree

    def _boot(self, kernel: Kernel, initramfs: Path, console: Path) -> Result:
        # fmt: off
        command = [
            tool("qemu-system-x86_64"), "-accel", "tcg", "-cpu", "qemu64", "-smp", "1",
            "-m", str(self.memory), "-icount", "shift=1,sleep=off",
            "-rtc", "base=2024-01-01,clock=vm", "-nodefaults", "-no-user-config", "-no-reboot",
            "-display", "none", "-serial", f"file:{console}", "-serial", "stdio",
            "-kernel", str(kernel.image), "-initrd", str(initramfs),
            "-append", "console=ttyS0 quiet panic=-1",
        ]
        # fmt: on
        try:
            done = subprocess.run(
                command, capture_output=True, stdin=subprocess.DEVNULL, timeout=self.timeout
            )
        except subprocess.TimeoutExpired as error:
            said = read_text(console)[-TAIL:] + (error.stdout or b"")[-TAIL:].decode(errors="replace")
            raise GuestFailed(f"no end after {self.timeout:g} s\n{said}") from None
        out = done.stdout.decode(errors="replace")
        log = read_text(console)
        verdict = re.search(r"^guest status (\d+)\r?$", log, re.MULTILINE)
        if not verdict:
            raise GuestFailed(f"no exit status\n{done.stderr.decode()}{log[-TAIL:]}{out[-TAIL:]}")
        return Result(int(verdict[1]), out, log)


def read_text(path: Path) -> str:
    return path.read_text(errors="replace") if path.exists() else ""


def tool(name: str) -> str:
    path = shutil.which(name, path=SEARCH_PATH)
    if not path:
        raise CannotRun(f"{name} is missing: apt-get install {TOOLS[name]}")
    return path


def checked(*command: str | Path, cwd: Path | None = None) -> str:
    """What a helper program prints; its failure means that there can be no machine."""
    done = subprocess.run(
        [tool(str(command[0])), *map(str, command[1:])],
        cwd=cwd,
        capture_output=True,
        text=True,
    )
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise CannotRun(f"{shlex.join(map(str, command))}: {reason}")
    return done.stdout


def debian_kernel(cache: Path) -> Kernel:
    """The kernel kept in the cache; the newest of Debian's cloud kernels if there is none yet."""
    if platform.machine() != "x86_64":
        raise CannotRun(f"the machine is an x86_64, this computer is {platform.machine()}")
    for name in TOOLS:
        tool(name)
    tree = cache.absolute() / "kernel"
    if not tree.exists():
        fetch_kernel(tree)
    return Kernel(next(tree.glob("boot/vmlinuz-*")), modules_of(tree))


def fetch_kernel(tree: Path) -> None:
    """Downloads and unpacks it beside its place, so that an interrupted one leaves nothing."""
    depends = subprocess.run(
        ["apt-cache", "depends", KERNEL_PACKAGE], capture_output=True, text=True
    ).stdout
    package = re.search(r"Depends: (linux-image-\S+)", depends)
    if not package:
        raise CannotRun(f"apt knows no {KERNEL_PACKAGE}: apt-get update")
    tree.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=tree.parent) as folder:
        checked("apt-get", "download", package[1], cwd=Path(folder))
        unpacked = Path(folder) / "kernel"
        checked("dpkg-deb", "-x", next(Path(folder).glob("*.deb")), unpacked)
        checked("depmod", "-b", unpacked, next(unpacked.glob("lib/modules/*")).name)
        try:
            unpacked.rename(tree)
        except OSError:
            if not tree.exists():  # else another one was faster
                raise


def modules_of(tree: Path) -> tuple[Path, ...]:
    """The wanted modules and those they need, these first."""
    release = next(tree.glob("lib/modules/*"))
    needs: dict[str, list[str]] = {}
    for line in (release / "modules.dep").read_text().splitlines():
        path, _, others = line.partition(":")
        needs[path] = others.split()  # the last has to be loaded first
    ordered: dict[str, None] = {}
    for wanted in MODULES:
        for path in needs:
            if Path(path).name.split(".ko")[0].replace("_", "-") == wanted:
                ordered.update(dict.fromkeys([*reversed(needs[path]), path]))
    return tuple(release / path for path in ordered)


def is_program(path: Path) -> bool:
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(4) == b"\x7fELF"


def copy_libraries(programs: Iterable[Path], tree: Path) -> list[str]:
    """Puts the shared libraries of programs where they are here; returns their folders."""
    folders: dict[str, None] = {}
    for program in programs:
        listing = subprocess.run(["ldd", str(program)], capture_output=True, text=True).stdout
        for library in re.findall(r"(/\S+) \(0x", listing):
            target = tree / library.lstrip("/")
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(library, target)
            folders[str(Path(library).parent)] = None
    return list(folders)


def pack(tree: Path, archive: Path) -> Path:
    names = "\0".join(str(path.relative_to(tree)) for path in tree.rglob("*"))
    with archive.open("wb") as file:
        subprocess.run(
            [tool("cpio"), "--null", "-o", "-H", "newc", "--quiet", "-R", "0:0"],
            cwd=tree, input=names.encode(), stdout=file, check=True,
        )  # fmt: skip
    return archive


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cache", type=Path, default=CACHE, help="keeps the kernel")
    parser.add_argument(
        "--file", action="append", default=[], metavar="GUEST=HERE", help="also in the machine"
    )
    parser.add_argument("--memory", type=int, default=512, metavar="MiB")
    parser.add_argument("--timeout", type=float, default=120, metavar="SECONDS")
    parser.add_argument("--console", action="store_true", help="what the kernel said, on stderr")
    parser.add_argument("program", type=Path)
    parser.add_argument("arguments", nargs=argparse.REMAINDER)
    words = parser.parse_args()
    files = {place: Path(source) for place, _, source in (f.partition("=") for f in words.file)}
    guest = Guest(
        words.program,
        words.arguments,
        files,
        memory=words.memory,
        timeout=words.timeout,
        cache=words.cache,
    )
    try:
        result = guest.run()
    except CannotRun as reason:
        print(f"skipped: {reason}", file=sys.stderr)
        return SKIPPED
    except (GuestFailed, OSError) as reason:
        print(f"the virtual machine failed: {reason}", file=sys.stderr)
        return 1
    if words.console:
        print(result.console, file=sys.stderr)
    print(result.out, end="")
    return result.status


if __name__ == "__main__":
    sys.exit(main())
