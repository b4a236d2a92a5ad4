"""The workers of a Dask scheduler, checked before work is sent to them."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import urlsplit

from app.child import typed_python
from app.cli.batch_inputs import own_digests, program_digest
from app.errors import UsageError
from app.version import program_version

if TYPE_CHECKING:
    from distributed import Client

REACH_S: Final = 3.0
"""Longest wait in seconds for any response of a computer."""
CONNECT_S: Final = 6.0
"""Longest wait in seconds for the scheduler and for its workers, each."""
_BY_TCP: Final = ("tcp", "tls")


@contextmanager
def cluster_executor(address: str) -> Iterator[Executor]:
    """Yield an executor that runs on a Dask scheduler's workers, after checking that all have this program and these
    user files.

    Raises
    ------
    UsageError
        The scheduler cannot be reached, or its workers differ.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise UsageError("dask.missing", python=typed_python()) from error
    _reach(address)
    try:
        client = Client(address, timeout=CONNECT_S)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise UsageError("dask.unreachable", address=address, reason=str(error)) from error
    with client:
        _check_workers(client, address)
        yield client.get_executor(pure=False)  # type: ignore[no-untyped-call]


def _reach(address: str) -> None:
    """Raise UsageError if nothing listens at a TCP address, since a client would keep trying for long."""
    try:
        place = urlsplit(address)
        if place.scheme in _BY_TCP and place.hostname and place.port:
            socket.create_connection((place.hostname, place.port), timeout=REACH_S).close()
    except (OSError, ValueError) as error:
        raise UsageError("dask.unreachable", address=address, reason=str(error)) from error


def _check_workers(client: Client, address: str) -> None:
    try:
        client.wait_for_workers(1, timeout=CONNECT_S)
    except TimeoutError as error:
        raise UsageError("dask.no_workers", address=address) from error
    asking = ThreadPoolExecutor(1)
    try:
        answers = asking.submit(client.run, probe(), on_error="return").result(CONNECT_S)
    except TimeoutError as error:
        raise UsageError("dask.silent_workers", address=address) from error
    finally:
        asking.shutdown(wait=False)
    for worker, answer in answers.items():
        check_worker(worker, answer)


def check_worker(worker: str, answer: Mapping[str, Any] | BaseException) -> None:
    """Raise UsageError if a worker would export files that differ from this machine's.

    Parameters
    ----------
    worker : str
        Address of the worker.
    answer : mapping or exception
        Result of `probe`, or the error that occurred instead.
    """
    if not isinstance(answer, Mapping) or "program" not in answer:
        raise UsageError("dask.no_program", worker=worker)
    if answer["program"] != program_digest():
        raise UsageError("dask.other_program", worker=worker, version=answer["version"], own=program_version())
    own, theirs = own_digests(), answer["own"]
    kinds = [kind for kind in own if theirs.get(kind) != own[kind]]
    if kinds:
        raise UsageError("dask.other_files", worker=worker, kinds=", ".join(kinds))


def machine_facts() -> dict[str, Any]:
    """Return digests of the program and the user's files of this machine, since only machines with equal ones may share
    work.
    """
    return {"version": program_version(), "program": program_digest(), "own": own_digests()}


def probe() -> Callable[[], dict[str, Any]]:
    """Return a function that returns `machine_facts`.

    It is sent to workers by value, since a worker may lack this module.
    """

    def facts() -> dict[str, Any]:
        try:
            from app.cli.cluster import machine_facts
        except ImportError:
            return {}
        return machine_facts()

    return facts
