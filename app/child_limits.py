"""Limits of all child processes: memory, processor time, elapsed time and output.

There is a row of `LIMITS` for each kind of child. A foreign program (ffmpeg) is started through `limited_command`,
which sets the limits before it runs; `confine` does the same where a running process is needed (Windows). Modules of
this program call `confine_this_process` first.

A limit is the sum of a constant and a part proportional to the input's size: a small file that needs much is damaged or
hostile.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final

_MB: Final = 2**20
_GB: Final = 2**30


@dataclass(frozen=True)
class ChildLimits:
    """Limits of a kind of child process; None for no limit, with the reason in `LIMITS`.

    Attributes
    ----------
    memory_bytes, memory_per_byte, most_memory_bytes : int
        Address space in bytes: a constant, an addition for each byte read, and the maximum.
    cpu_s, cpu_s_per_mb : float
        Processor time in seconds: a constant, and an addition per megabyte read.
    wall_s : float
        Elapsed time in seconds after which this process ends the child.
    written_bytes : int
        Size in bytes of the largest file that the child may write.
    """

    memory_bytes: int | None = None
    memory_per_byte: int = 0
    most_memory_bytes: int = 64 * _GB
    cpu_s: float | None = None
    cpu_s_per_mb: float = 0.0
    wall_s: float | None = None
    written_bytes: int | None = None

    def memory_of(self, size: int) -> int | None:
        """Bytes of address space for an input of ``size`` bytes."""
        if self.memory_bytes is None:
            return None
        return min(self.memory_bytes + self.memory_per_byte * size, self.most_memory_bytes)

    def cpu_of(self, size: int) -> int | None:
        """Seconds of processor time for an input of ``size`` bytes, rounded up."""
        return None if self.cpu_s is None else -int(-(self.cpu_s + self.cpu_s_per_mb * size / _MB) // 1)


LIMITS: Final[Mapping[str, ChildLimits]] = MappingProxyType(
    {
        # Reading the first picture of a film. Frames of 8192 x 8192 take 100 MB, and a decoder keeps several.
        "ffmpeg.facts": ChildLimits(_GB, 64, 4 * _GB, cpu_s=4.0, cpu_s_per_mb=8.0, wall_s=30.0, written_bytes=0),
        # ffmpeg waits while no picture is requested, so wall-clock time is unlimited; a megabyte can hold minutes of a
        # static screen recording.
        "ffmpeg.pictures": ChildLimits(_GB, 64, 4 * _GB, cpu_s=4.0, cpu_s_per_mb=200.0, written_bytes=0),
        # The reading side counts the output and stops ffmpeg. A megabyte holds up to ten minutes of speech.
        "ffmpeg.sound": ChildLimits(_GB, 16, 2 * _GB, cpu_s=4.0, cpu_s_per_mb=10.0, written_bytes=0),
        # Encoding our own pictures and sound, whose length the user chose. x264 keeps about sixty frames.
        "ffmpeg.encode": ChildLimits(12 * _GB),
        "ffmpeg.join": ChildLimits(12 * _GB),
        # ufbx reads foreign files.
        "ufbx.figure": ChildLimits(512 * _MB, 64, cpu_s=3.0, cpu_s_per_mb=4.0, wall_s=180.0, written_bytes=0),
        "ufbx.motion": ChildLimits(512 * _MB, 64, cpu_s=3.0, cpu_s_per_mb=8.0, wall_s=180.0, written_bytes=0),
        # DracoPy and meshopt decode compressed parts of glTF files.
        "unpacker": ChildLimits(512 * _MB, 64, cpu_s=3.0, cpu_s_per_mb=4.0, wall_s=180.0, written_bytes=0),
        # Our own modules process values that were validated when read. The recorder runs as long as a take, the others
        # until their input ends.
        "recorder": ChildLimits(8 * _GB),
        "render": ChildLimits(4 * _GB, written_bytes=0),
        "export": ChildLimits(48 * _GB),
        # A graphics driver may reserve any amount of address space. The process ends when the evaluation is stopped.
        "evaluation": ChildLimits(),
        # The whole program, run for each piece of a folder; the processes it starts have the limits above.
        "batch": ChildLimits(),
    }
)


def limited_command(name: str, command: Sequence[str], size: int = 0) -> list[str]:
    """Wrap a command so that it runs within limits; on Windows the command is returned unchanged, see `confine`.

    Parameters
    ----------
    name : str
        Name of a row of `LIMITS`.
    size : int
        Size of the input in bytes.
    """
    if os.name != "posix":
        return list(command)
    limits = LIMITS[name]
    memory, cpu_s, written = limits.memory_of(size), limits.cpu_of(size), limits.written_bytes
    # A lower limit set by the system is kept. Units: KB, seconds, blocks of 512 bytes.
    said = [
        *([f"ulimit -v {memory // 1024}"] if memory is not None else []),
        *([f"ulimit -t {cpu_s}"] if cpu_s is not None else []),
        *([f"ulimit -f {written // 512}"] if written is not None else []),
        "ulimit -c 0",
    ]
    script = "; ".join(f"{line} 2>/dev/null" for line in said) + '; exec "$@"'
    return ["/bin/sh", "-c", script, "suisou", *command]


def confine(name: str, process: subprocess.Popen[bytes], size: int = 0) -> WindowsJob | None:
    """Set the limits of a newly started process: on Windows by a job object; elsewhere `limited_command` has done so.

    Returns
    -------
    WindowsJob or None
        Job that must be kept as long as the process runs; None elsewhere.

    Raises
    ------
    OSError
        The system refuses the limits.
    """
    if sys.platform != "win32":
        return None
    kernel32 = ctypes.WinDLL("kernel32", use_last_error=True)
    limits = LIMITS[name]
    job = WindowsJob(kernel32, limits.memory_of(size), limits.cpu_of(size))
    if not job.take(int(process._handle)) and process.poll() is None:
        raise OSError(ctypes.get_last_error(), "the process cannot be put into a job")
    return job


def confine_this_process(name: str, size: int = 0) -> None:
    """Set the limits of this process in addition to its present use; on Windows its parent does so by `confine`."""
    if sys.platform == "win32":
        return
    import resource

    limits = LIMITS[name]
    memory, cpu_s, written = limits.memory_of(size), limits.cpu_of(size), limits.written_bytes
    used = resource.getrusage(resource.RUSAGE_SELF)
    _lower(resource.RLIMIT_CORE, 0)
    if cpu_s is not None:
        _lower(resource.RLIMIT_CPU, int(used.ru_utime + used.ru_stime) + cpu_s)
    if written is not None:
        _lower(resource.RLIMIT_FSIZE, written)
    if memory is not None and sys.platform == "linux":
        # Other systems do not enforce a limit on the address space.
        with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123 - of the system
            pages = int(file.read().split()[0])
        _lower(resource.RLIMIT_AS, pages * resource.getpagesize() + memory)


def _lower(which: int, value: int) -> None:
    """Set the limit ``which`` of this process, unless the system's limit is lower already."""
    import resource

    _, hard = resource.getrlimit(which)
    value = value if hard == resource.RLIM_INFINITY else min(value, hard)
    resource.setrlimit(which, (value, value))


class _BasicLimits(ctypes.Structure):
    """JOBOBJECT_BASIC_LIMIT_INFORMATION of the Windows API (winnt.h)."""

    _fields_ = (
        ("PerProcessUserTimeLimit", ctypes.c_int64),
        ("PerJobUserTimeLimit", ctypes.c_int64),
        ("LimitFlags", ctypes.c_uint32),
        ("MinimumWorkingSetSize", ctypes.c_size_t),
        ("MaximumWorkingSetSize", ctypes.c_size_t),
        ("ActiveProcessLimit", ctypes.c_uint32),
        ("Affinity", ctypes.c_size_t),
        ("PriorityClass", ctypes.c_uint32),
        ("SchedulingClass", ctypes.c_uint32),
    )


class JobLimits(ctypes.Structure):
    """JOBOBJECT_EXTENDED_LIMIT_INFORMATION of the Windows API (winnt.h)."""

    _fields_ = (
        ("BasicLimitInformation", _BasicLimits),
        ("IoInfo", ctypes.c_uint64 * 6),
        ("ProcessMemoryLimit", ctypes.c_size_t),
        ("JobMemoryLimit", ctypes.c_size_t),
        ("PeakProcessMemoryUsed", ctypes.c_size_t),
        ("PeakJobMemoryUsed", ctypes.c_size_t),
    )


_PROCESS_TIME, _PROCESS_MEMORY, _KILL_ON_CLOSE = 0x2, 0x100, 0x2000
_EXTENDED_LIMITS: Final = 9


def job_limits(memory: int | None, cpu_s: int | None) -> JobLimits:
    """Return the limits of a Windows job, whose processes end when its handle is closed."""
    limits = JobLimits()
    basic = limits.BasicLimitInformation
    basic.LimitFlags = _KILL_ON_CLOSE
    if memory is not None:
        basic.LimitFlags |= _PROCESS_MEMORY
        limits.ProcessMemoryLimit = memory
    if cpu_s is not None:
        basic.LimitFlags |= _PROCESS_TIME
        basic.PerProcessUserTimeLimit = cpu_s * 10_000_000
    return limits


class WindowsJob:
    """A Windows job object, whose processes have its limits and end with it.

    Parameters
    ----------
    kernel32 : library
        The Windows library kernel32.
    memory : int, optional
        Largest memory of a process in bytes.
    cpu_s : int, optional
        Processor time in seconds.

    Raises
    ------
    OSError
        The system refuses.
    """

    def __init__(self, kernel32: Any, memory: int | None, cpu_s: int | None) -> None:
        kernel32.CreateJobObjectW.restype = ctypes.c_void_p
        self._kernel32 = kernel32
        self._handle = ctypes.c_void_p(kernel32.CreateJobObjectW(None, None))
        limits = job_limits(memory, cpu_s)
        said = ctypes.byref(limits), ctypes.sizeof(limits)
        if not self._handle or not kernel32.SetInformationJobObject(self._handle, _EXTENDED_LIMITS, *said):
            raise OSError("no job with limits can be made")

    def take(self, process: int) -> bool:
        """Add a process to the job by its handle; return false if the system refuses."""
        return bool(self._kernel32.AssignProcessToJobObject(self._handle, ctypes.c_void_p(process)))

    def __del__(self) -> None:
        if self._handle:
            self._kernel32.CloseHandle(self._handle)
