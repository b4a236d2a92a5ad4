"""Files of a project on another computer are not accessed when it is opened, saved, performed and exported."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.choreography.performed.choreographers import choreographer_of
from app.cli import main
from app.errors import AppError
from app.formats.other_computers import agree
from app.performance.ensemble import Performance
from app.project.midi_out import export_midi
from app.project.storage import elsewhere, load, missing, missing_media, save
from instrument_maps.library import all_maps
from tests.support.elsewhere import SHARES, on_share, paths_on
from tests.support.touched import Touched
from tests.unit.project.pieces import small_project

share = pytest.mark.parametrize("share", SHARES)


@share
def test_a_project_is_opened_performed_and_saved_without_a_look(tmp_path: Path, touched: Touched, share: str) -> None:
    path = tmp_path / "piece.suisou"
    save(on_share(small_project(), share), path)
    project = load(path)
    assert elsewhere(project) == paths_on(share)[:4]
    assert missing_media(project) is None
    found = [message for message in missing(project) if message.id == "project.choreography_elsewhere"]
    assert [message.arguments["host"] for message in found] == ["host", "host"]
    performance = Performance(project)
    performance.prepare()
    for player in project.players:
        performance.problems(player.id)
    with pytest.raises(AppError, match=r"other_computer"):
        choreographer_of(project.dancers[0].choreography)
    export_midi(project, tmp_path / "out.mid", all_maps())
    save(project, path)
    assert load(path) == project
    assert touched.elsewhere == []


@share
def test_what_was_agreed_to_is_looked_for(tmp_path: Path, touched: Touched, share: str) -> None:
    project = on_share(small_project(), share)
    agree(r"\\host\other\file.wav")
    assert elsewhere(project) == ()
    assert str(missing_media(project)) == str(Path(paths_on(share)[0]))
    assert "project.choreography_file_missing" in [message.id for message in missing(project)]
    assert set(touched.elsewhere) >= {paths_on(share)[0], paths_on(share)[3]}


def test_commands_leave_it_alone_unless_they_name_it(
    tmp_path: Path, touched: Touched, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "piece.suisou"
    save(on_share(small_project(), SHARES[0]), path)
    assert main(["inspect", str(path)]) == 0
    written = capsys.readouterr()
    assert "another computer (host)" in written.out + written.err
    main(["export", str(path), "--to", str(tmp_path / "out"), "--format", "bvh", "--jobs", "1"])
    capsys.readouterr()
    assert touched.elsewhere == []
    main(["align", str(path), r"\\host\share\take.wav", "--to", str(tmp_path / "a.mid")])
    capsys.readouterr()
    assert r"\\host\share\take.wav" in touched.elsewhere
