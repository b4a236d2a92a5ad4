"""``suisou choreography``: learns dancers' motion to music, and generates dances to a piece."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from app.cli.commands import Actions, add_actions
from app.cli.options import bounded_number, frame_rate, seconds, whole_number
from app.cli.progress import Progress
from app.cli.speech import said, sentence
from app.cli.status import DONE, PARTIAL
from app.cli.summary import columns, heads
from app.cli.terminal import say, warn
from app.encoding import shown
from app.errors import AppError, Cancelled, UsageError
from app.project.frame_rate import USUAL_RATE

if TYPE_CHECKING:
    from app.choreography.dance import Dance
    from app.choreography.model import ChoreographyModel
    from app.choreography.read_pair import ReadPair


MOST_STATES: Final = 1000
MOST_DANCERS: Final = 32


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou choreography``."""
    actions = add_actions(command, required=True)
    _add_learn(actions)
    _add_generate(actions)


# -------------------------------------------------------------------------------------------------------------- learn


@dataclass(frozen=True)
class PairFiles:
    """A pair of files with motion and its music (paths), and the options typed for this pair."""

    motion: Path
    music: Path
    offset_s: float | None = None
    fps: Fraction | None = None
    credits: Path | None = None
    cuts: Path | None = None
    joints: Mapping[str, str] = field(default_factory=dict)
    figure: str | None = None


class _AddPair(argparse.Action):
    """Handles the option ``--pair MOTION PIECE`` of argparse: appends a pair."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, option: str | None = None
    ) -> None:
        namespace.pairs = (*namespace.pairs, PairFiles(*values))


class _OfPair(argparse.Action):
    """Handles an option of argparse that applies to the ``--pair`` typed before it: sets a field of that pair."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, option: str | None = None
    ) -> None:
        if not namespace.pairs:
            raise argparse.ArgumentError(self, said("learn.no_pair"))
        *before, pair = namespace.pairs
        if getattr(pair, self.dest) is not None:
            raise argparse.ArgumentError(self, said("learn.twice", motion=pair.motion.name))
        namespace.pairs = (*before, replace(pair, **{self.dest: values}))


class _CorrectBone(argparse.Action):
    """Handles ``--bone JOINT=NAME`` of argparse: corrects a bone of the ``--pair`` typed before it."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, option: str | None = None
    ) -> None:
        if not namespace.pairs:
            raise argparse.ArgumentError(self, said("learn.no_pair"))
        joint, equals, bone = values.partition("=")
        if not equals or not joint:
            raise argparse.ArgumentError(self, said("characters.joint", text=values))
        *before, pair = namespace.pairs
        if joint in pair.joints:
            raise argparse.ArgumentError(self, said("learn.joint_twice", motion=pair.motion.name, joint=joint))
        namespace.pairs = (*before, replace(pair, joints={**pair.joints, joint: bone}))


def _add_learn(actions: Actions) -> None:
    command = actions.add_parser("learn", help="")
    command.add_argument(
        "--pair",
        dest="pairs",
        action=_AddPair,
        nargs=2,
        type=Path,
        default=(),
        required=True,
        metavar=("MOTION", "PIECE"),
    )
    of_pair = command.add_argument_group(said("cli.pair_options"))

    def add(option: str, **more: Any) -> None:
        of_pair.add_argument(option, action=_OfPair, default=argparse.SUPPRESS, **more)

    add("--offset", dest="offset_s", type=seconds, metavar="SECONDS")
    add("--fps", type=frame_rate, metavar="RATE")
    add("--credits", type=Path, metavar="FILE")
    add("--cuts", type=Path, metavar="FILE")
    add("--figure", metavar="ROOT")
    of_pair.add_argument("--bone", action=_CorrectBone, default=argparse.SUPPRESS, metavar="JOINT=NAME")
    command.add_argument("--states", type=bounded_number(1, MOST_STATES, "quantity.basic_motions", int), metavar="K")
    command.add_argument("--seed", type=whole_number, default=0, metavar="N")
    command.add_argument("--to", type=Path, required=True, metavar="NAME.choreography")
    command.set_defaults(run=learn)


def learn(arguments: argparse.Namespace) -> int:
    """Learn from all readable pairs, write the file, print its contents, and return the exit status.

    Raises
    ------
    AppError
        If no pair could be used; the error of the first pair is raised.
    """
    from app.choreography.dancers_told_apart import reports
    from app.choreography.learn import learn as learned
    from app.choreography.model_file import write_model
    from app.choreography.music_offset import offset_doubt
    from app.choreography.read_pair import to_check
    from app.project.choreography_files import SUFFIX

    target: Path = arguments.to if arguments.to.suffix == SUFFIX else Path(f"{arguments.to}{SUFFIX}")
    progress = Progress(sys.stderr)
    try:
        read, left_out = _read_pairs(arguments.pairs, progress)
        if read:
            model = learned(
                [one.pair for one in read],
                states=arguments.states,
                seed=arguments.seed,
                name=shown(target.stem),
                progress=lambda share, label: progress(0.5 + 0.5 * share, label),
            )
            write_model(target, model)
    finally:
        progress.clear()
    if not read:
        for name, error in left_out[1:]:
            warn(said("learn.unusable", motion=name, reason=sentence(error.message)))
        raise left_out[0][1]
    say(*learned_table(model, target, [one.motion.start_s for one in read]), "", *map(sentence, reports(model)))
    notes = [f"  {one.pair.motion_name}: {', '.join(map(sentence, found))}" for one in read if (found := to_check(one))]
    say("", said("learn.body"), *(f"  {one.pair.motion_name}: {sentence(one.motion.checked)}" for one in read))
    if notes:
        say("", said("export_report.look_at"), *notes)
    for source, one in zip(model.sources, read, strict=True):
        if doubt := offset_doubt(source.offset_s + one.motion.start_s, source.offset_confidence):
            warn(f"{source.motion_name}: {sentence(doubt)}")
        if not source.credits:
            warn(said("learn.no_credits", motion=source.motion_name))
    for name, error in left_out:
        warn(said("learn.left_out", motion=name, reason=sentence(error.message)))
    return PARTIAL if left_out else DONE


def _read_pairs(files: Sequence[PairFiles], progress: Progress) -> tuple[list[ReadPair], list[tuple[str, AppError]]]:
    """Read pairs of motion and music.

    Returns
    -------
    (list, list)
        The pairs that could be read; and for each other pair the name of its motion with the error.
    """
    from app.choreography.learn import require_usable
    from app.choreography.read_pair import read_pair

    read, left_out = [], list[tuple[str, AppError]]()
    for number, one in enumerate(files):
        progress(0.5 * number / len(files), one.motion.name)
        try:
            found = read_pair(
                one.motion,
                one.music,
                offset_s=one.offset_s,
                fps=one.fps,
                credits=one.credits,
                cuts=one.cuts,
                joints=one.joints,
                figure=one.figure or "",
            )
            require_usable(found.pair)
            read.append(found)
        except Cancelled:
            raise
        except AppError as error:
            left_out.append((shown(one.motion.name), error))
    return read, left_out


def learned_table(model: ChoreographyModel, file: Path, starts_s: Sequence[float]) -> list[str]:
    """Return lines of a table: what was learned from each pair, and the pair's offset in seconds.

    Offsets are times in the input files; the clips of the model may start later.
    """
    from app.choreography.learn import summary
    from app.choreography.music_offset import CONFIDENT

    rows = [heads("learn.heads")]
    for number, (source, clip, start_s) in enumerate(zip(model.sources, model.clips, starts_s, strict=True)):
        states = [one.state for one in model.segments if one.clip == number]
        confidence = source.offset_confidence
        rows.append(
            (
                source.motion_name,
                source.music_name,
                f"{clip.length_s:.1f}",
                str(len(states)),
                str(len(set(states))),
                f"{source.offset_s + start_s:.2f}",
                said("learn.given")
                if confidence is None
                else f"{confidence:.2f}{'' if confidence >= CONFIDENT else '*'}",
            )
        )
    lines = [sentence(summary(model, file)), "", *columns(rows)]
    if any(source.offset_confidence is not None and source.offset_confidence < CONFIDENT for source in model.sources):
        lines.append(said("learn.doubtful_offset"))
    return lines


# ----------------------------------------------------------------------------------------------------------- generate


def _add_generate(actions: Actions) -> None:
    command = actions.add_parser("generate", help="")
    command.add_argument("choreography", metavar="NAME.choreography")
    command.add_argument("piece", type=Path, metavar="PIECE")
    command.add_argument("--to", type=Path, required=True, metavar="OUT.bvh")
    command.add_argument(
        "--dancers", type=bounded_number(1, MOST_DANCERS, "quantity.dancers", int), default=1, metavar="N"
    )
    command.add_argument("--formation", type=_formation, default="unison", metavar="NAME")
    command.add_argument("--seed", type=whole_number, default=0, metavar="N")
    command.add_argument("--prefer", metavar="MOTION")
    command.add_argument("--size", type=bounded_number(0.0, 1.5, "quantity.size", float), default=1.0, metavar="FACTOR")
    command.add_argument(
        "--weight", type=bounded_number(-1.0, 1.0, "quantity.weight", float), default=0.0, metavar="WEIGHT"
    )
    command.add_argument(
        "--melody", type=bounded_number(0.0, 1.0, "quantity.amount", float), default=0.5, metavar="AMOUNT"
    )
    command.add_argument("--fps", type=frame_rate, default=USUAL_RATE, metavar="RATE")
    command.set_defaults(run=generate)


def _formation(name: str) -> str:
    """Return a formation by name, importing its module only when needed."""
    from app.choreography.formation import FORMATIONS

    if name not in FORMATIONS:
        raise argparse.ArgumentTypeError(said("cli.not_one_of", typed=name, possible=", ".join(FORMATIONS)))
    return name


def generate(arguments: argparse.Namespace) -> None:
    """Generate dances, write the files and print a table."""
    from app.choreography.clip import write_motion
    from app.choreography.dance import Manner
    from app.choreography.derived_rhythm import audible_rhythm
    from app.choreography.formation import dance_together, roles
    from app.choreography.generate import Choreographer
    from app.choreography.model_file import read_model
    from app.project.choreography_files import bundled_choreographies, choreography_path
    from app.score.contents import uncast_score
    from app.score.read import read_contents

    name: str = arguments.choreography
    model = read_model(choreography_path(name) if name in bundled_choreographies() else Path(name))
    rhythm = audible_rhythm(uncast_score(read_contents(arguments.piece)))
    source = _source(model, arguments.prefer)
    manner = Manner(arguments.seed, source, arguments.size, arguments.weight, melody=arguments.melody)
    cast = roles(arguments.formation, arguments.dancers, manner, len(model.sources))
    progress = Progress(sys.stderr)
    try:
        progress(0.0, shown(arguments.piece.name))
        dances = dance_together(Choreographer(model), rhythm, cast, arguments.fps)
        files = _dancers_files(arguments.to, len(dances))
        for number, (file, dance) in enumerate(zip(files, dances, strict=True)):
            progress((number + 1) / (len(dances) + 1), shown(file.name))
            write_motion(file, dance.clip)
    finally:
        progress.clear()
    say(*generated_table(model, files, dances))
    if rhythm.derived:
        say("", said("generate.derived"))


def generated_table(model: ChoreographyModel, files: Sequence[Path], dances: Sequence[Dance]) -> list[str]:
    """Return a table of each dancer's clips and the range of their speeds relative to the capture."""
    import numpy as np

    rows = [heads("generate.heads")]
    for file, dance in zip(files, dances, strict=True):
        used = {step.segment for step in dance.steps}
        times_s = dance.first_s + np.arange(len(dance.clip)) / float(dance.clip.fps)
        danced = (
            (times_s >= dance.steps[0].start_s) & (times_s <= dance.steps[-1].end_s) if dance.steps else times_s < 0
        )
        slow, fast = np.percentile(dance.speeds[danced], (1.0, 99.0)) if danced.any() else (1.0, 1.0)
        rows.append(
            (
                shown(str(file)),
                f"{dance.clip.length_s:.1f}",
                str(len(dance.steps)),
                str(len({step.state for step in dance.steps})),
                f"{100.0 * len(used) / len(model.segments):.0f} %",
                str(len(dance.seams)),
                said("generate.speeds", slow=slow, fast=fast),
            )
        )
    return columns(rows)


def _source(model: ChoreographyModel, name: str | None) -> int | None:
    """Return the index of a source of the choreography by the name of its motion; None if no name is given.

    Raises
    ------
    UsageError
        If there is no such source.
    """
    if name is None:
        return None
    names = [source.motion_name for source in model.sources]
    if name not in names:
        raise UsageError("generate.no_source", source=name, sources=", ".join(names))
    return names.index(name)


def _dancers_files(target: Path, dancers: int) -> list[Path]:
    """Return the output file of each dancer: the target itself for one, numbered files for several."""
    if target.suffix.lower() != ".bvh":
        target = Path(f"{target}.bvh")
    if dancers == 1:
        return [target]
    return [target.with_name(f"{target.stem}_{number}{target.suffix}") for number in range(1, dancers + 1)]
