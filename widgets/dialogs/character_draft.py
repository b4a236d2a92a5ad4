"""Settings of a character while the user assigns joints and face shapes, and the resulting mapping."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Literal

from PySide6.QtCore import QCoreApplication

from app.editor.translated import tr
from app.errors import Message
from app.rig.characters.face_map import FaceMapping, map_morphs
from app.rig.characters.figure_build import figure_height, has_odd_height
from app.rig.characters.figure_to_character import figure_character
from app.rig.characters.joint_mapping import JointMapping, map_joints
from app.rig.characters.props import props_in_hands
from app.rig.characters.split_hands import bones_beside_hands
from app.rig.figure import Figure
from app.rig.model import Character
from metadata.model import REQUIRED_JOINTS

State = Literal["mapped", "doubtful", "missing"]

_FINGERS: Final = ("Thumb", "Index", "Middle", "Ring", "Little")
_SIDES: Final = ("left", "right")
_LIPS: Final = ("mouthPucker", "mouthFunnel", "mouthClose", "mouthPressLeft", "mouthPressRight")
_MOST_STEPS: Final = 200


@dataclass(frozen=True)
class CharacterDraft:
    """The user's settings of a character.

    Attributes
    ----------
    joints : mapping of str to str
        Corrected bones by joint; empty for none.
    morphs : mapping of str to mapping of str to float
        Corrected morph weights by ARKit shape.
    height_m : float
        Height of the character; 0 for the height in the file.
    hidden : tuple of str
        Hidden meshes of the file.
    """

    title: str
    joints: Mapping[str, str] = field(default_factory=dict)
    morphs: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    height_m: float = 0.0
    hidden: tuple[str, ...] = ()

    def with_joint(self, joint: str, bone: str | None) -> CharacterDraft:
        """Return the draft with another bone for a joint; an empty name for no bone, None for the automatic one."""
        joints = {name: own for name, own in self.joints.items() if name != joint}
        return replace(self, joints=joints if bone is None else {**joints, joint: bone})

    def with_face(self, face: str, parts: Mapping[str, float] | None) -> CharacterDraft:
        """Return the draft with other morphs for a face shape; an empty mapping for none, None for the
        automatic ones.
        """
        morphs = {name: own for name, own in self.morphs.items() if name != face}
        return replace(self, morphs=morphs if parts is None else {**morphs, face: dict(parts)})


def found_by_itself(figure: Figure, title: str) -> CharacterDraft:
    """Return the draft without any setting by the user; props in the hands are hidden."""
    return CharacterDraft(title, hidden=props_in_hands(figure, map_joints(figure).bones))


@dataclass(frozen=True, eq=False)
class Mapped:
    """Joints and face shapes found in a figure with the corrections of a draft, and the joint of each used bone."""

    draft: CharacterDraft
    joints: JointMapping
    faces: FaceMapping
    used: Mapping[int, str]

    @property
    def lacking(self) -> tuple[str, ...]:
        """Return the missing joints without which a character cannot play."""
        return tuple(joint for joint in REQUIRED_JOINTS if joint not in self.joints.bones)

    def state(self, joint: str) -> State:
        """Return the reliability of the bone found for a joint."""
        if joint not in self.joints.bones:
            return "missing"
        return "doubtful" if joint in self.joints.doubtful else "mapped"


def mapped(figure: Figure, draft: CharacterDraft, before: Mapped | None = None) -> Mapped:
    """Return the joints and face shapes of a figure with a draft's corrections; unchanged results of ``before`` are
    reused.

    Raises FileError if the draft refers to bones or morphs that the figure lacks.
    """
    same_joints = before is not None and before.draft.joints == draft.joints
    same_faces = before is not None and before.draft.morphs == draft.morphs
    joints = before.joints if before is not None and same_joints else map_joints(figure, draft.joints)
    faces = before.faces if before is not None and same_faces else map_morphs(figure, draft.morphs)
    used = bones_beside_hands(figure, joints.bones) | {bone: joint for joint, bone in joints.bones.items()}
    return Mapped(draft, joints, faces, used)


def character_of(figure: Figure, made: Mapped) -> Character:
    """Return the character that results from a mapping. Raises FileError if it cannot play."""
    figure = figure.without(made.draft.hidden)
    return figure_character(figure, made.draft.title, made.joints.bones, made.faces.morphs, made.draft.height_m)


def nothing_shown(figure: Figure, draft: CharacterDraft) -> bool:
    """Return whether a draft hides every mesh of a figure."""
    return all(mesh.name in draft.hidden for mesh in figure.meshes)


class DraftHistory:
    """Undo history of the drafts of a character."""

    def __init__(self, first: CharacterDraft) -> None:
        self._done, self._undone = [first], list[CharacterDraft]()
        self._gesture: object | None = None
        self._of_gesture = False
        """True if the last step belongs to the running gesture."""

    @classmethod
    def empty(cls) -> DraftHistory:
        """Return a history that begins without corrections."""
        return cls(CharacterDraft(""))

    @property
    def now(self) -> CharacterDraft:
        """The draft of the character after the last change or undo."""
        return self._done[-1]

    @property
    def can_undo(self) -> bool:
        """True if there is a step to undo."""
        return len(self._done) > 1

    @property
    def can_redo(self) -> bool:
        """True if there is a step to redo."""
        return bool(self._undone)

    def apply(self, draft: CharacterDraft, gesture: object | None = None) -> bool:
        """Add a draft as the current step, replacing the last one of the same gesture, and return whether it
        differs.
        """
        before = self.now
        if gesture is not None and gesture is self._gesture and self._of_gesture:
            self._done.pop()
        self._gesture, self._of_gesture = gesture, draft != self.now
        if self._of_gesture:
            self._done = [*self._done[-_MOST_STEPS:], draft]
            self._undone.clear()
        return self.now != before

    def undo(self) -> None:
        """Return to the draft before the last change."""
        if self.can_undo:
            self._undone.append(self._done.pop())
            self._gesture, self._of_gesture = None, False

    def redo(self) -> None:
        """Redo the last undone step."""
        if self._undone:
            self._done.append(self._undone.pop())
            self._gesture, self._of_gesture = None, False


def not_played(figure: Figure, made: Mapped) -> tuple[str, ...]:
    """Return texts about what a character will not do, the most severe first."""
    _translate, reported = QCoreApplication.translate, list[str]()
    bones, faces = made.joints.bones, made.faces.morphs
    if made.lacking and not figure.is_skinned:
        reported.append(tr("character_words.no_skeleton"))
    elif made.lacking:
        reported.append(
            tr("character_words.it_cannot_play_yet_choose").format(
                joints=", ".join(joint_name(joint) for joint in made.lacking)
            )
        )
    if has_odd_height(figure) and not made.draft.height_m:
        height_m = f"{figure_height(figure) or 0.0:.2f}"
        reported.append(tr("character_words.height_is_odd").format(height=height_m))
    reported += _props(figure, made)
    without = [
        (side, finger)
        for side in _SIDES
        for finger in _FINGERS
        if not any(joint.startswith(side + finger) for joint in bones)
    ]
    if len(without) == 2 * len(_FINGERS):
        reported.append(tr("character_words.it_has_no_finger_bones"))
    elif without:
        reported.append(
            tr("character_words.these_fingers_do_not_move").format(
                fingers=", ".join(joint_name(side + finger) for side, finger in without)
            )
        )
    if "leftEye" not in bones and "rightEye" not in bones and not any(name.startswith("eyeLook") for name in faces):
        reported.append(tr("character_words.no_gaze"))
    if "jaw" not in bones and "jawOpen" not in faces:
        reported.append(tr("character_words.mouth_does_not_open_it"))
    if not any(name in faces for name in _LIPS):
        reported.append(tr("character_words.lips_do_not_form_embouchure"))
    if not any(name.startswith("eyeBlink") for name in faces):
        reported.append(tr("character_words.no_blinking"))
    if "cheekPuff" not in faces:
        reported.append(tr("character_words.no_cheeks"))
    return tuple(reported)


def notes_beside_joints(made: Mapped, notes: Sequence[Message]) -> tuple[Message, ...]:
    """Return those notes about a body that `not_played` does not repeat: about sizes, and skin that follows no bone."""
    bones = made.joints.bones
    fingers = all(any(bone.startswith(side + finger) for bone in bones) for side in _SIDES for finger in _FINGERS)
    said = {"character.lips_still"} | (set() if fingers else {"character.no_fingers", "character.some_fingers"})
    return tuple(note for note in notes if note.id not in said)


def _props(figure: Figure, made: Mapped) -> list[str]:
    """Return sentences about props in the hands, whether hidden or shown."""
    props = props_in_hands(figure, made.joints.bones)
    sentences = []
    for id, hidden in (("character_words.props_left_out", True), ("character_words.props_shown", False)):
        names = ", ".join(name for name in props if (name in made.draft.hidden) == hidden)
        if names:
            sentences.append(tr(id).format(names=names))
    return sentences


def joint_name(joint: str) -> str:
    """Return the name of a joint in the user's language."""
    for side, sign in (("left", tr("joint.l")), ("right", tr("joint.r"))):
        if joint.startswith(side):
            return sign.format(part=joint_name(joint.removeprefix(side)))
    words = {
        "hips": tr("joint.hips"),
        "spine": tr("joint.spine"),
        "chest": tr("joint.chest"),
        "upperChest": tr("joint.upper_chest"),
        "neck": tr("joint.neck"),
        "head": tr("joint.head"),
        "jaw": tr("joint.jaw"),
        "Eye": tr("joint.eye"),
        "Shoulder": tr("joint.shoulder"),
        "UpperArm": tr("joint.upper_arm"),
        "LowerArm": tr("joint.lower_arm"),
        "Hand": tr("joint.hand"),
        "UpperLeg": tr("joint.upper_leg"),
        "LowerLeg": tr("joint.lower_leg"),
        "Foot": tr("joint.foot"),
        "Toes": tr("joint.toes"),
        "Thumb": tr("joint.thumb"),
        "Index": tr("joint.index_finger"),
        "Middle": tr("joint.middle_finger"),
        "Ring": tr("joint.ring_finger"),
        "Little": tr("joint.little_finger"),
        "ThumbMetacarpal": tr("joint.thumb_base"),
        "ThumbProximal": tr("joint.thumb_middle"),
        "ThumbDistal": tr("joint.thumb_tip"),
        "IndexProximal": tr("joint.index_finger_base"),
        "IndexIntermediate": tr("joint.index_finger_middle"),
        "IndexDistal": tr("joint.index_finger_tip"),
        "MiddleProximal": tr("joint.middle_finger_base"),
        "MiddleIntermediate": tr("joint.middle_finger_middle"),
        "MiddleDistal": tr("joint.middle_finger_tip"),
        "RingProximal": tr("joint.ring_finger_base"),
        "RingIntermediate": tr("joint.ring_finger_middle"),
        "RingDistal": tr("joint.ring_finger_tip"),
        "LittleProximal": tr("joint.little_finger_base"),
        "LittleIntermediate": tr("joint.little_finger_middle"),
        "LittleDistal": tr("joint.little_finger_tip"),
    }
    return words.get(joint, joint)
