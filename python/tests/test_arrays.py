"""Recordings that stand in no folder: frames and arrays, and answers that go when nobody holds them."""

import gc
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import rig

import smam
from smam._laws import laws_of_scene
from smam._program import find_program
from smam._toml import document

LEAK = {"name": "leak", "element": "line", "conductance_m3_s_pa": 5e-18}


def test_arrays_are_diagnosed_drawn_and_leave_nothing(folder: Path) -> None:
    runs = rig.record({"effect": [LEAK]})
    found = smam.diagnose(runs, scene="muscle_bench", noise=rig.NOISE, holdout=["chirp"])
    assert (found.verdict, found.effects["name"].tolist()) == ("missing_physics", ["leak"])
    assert found.raw["fit"]["holdout"] == ["chirp.csv"]
    assert found.laws == []  # an effect of the catalogue
    page = found._repr_html_()
    assert page is not None and page.startswith("<iframe srcdoc=") and "leak" in page
    pytest.importorskip("matplotlib").use("Agg")
    figure = found.plot()
    assert [axis.get_ylabel() for axis in figure.axes[::2]] == list(rig.NOISE)
    assert len(figure.axes[1].lines) == 2
    with pytest.raises(ValueError, match="there is no run x; the runs are sine, steps, chirp"):
        found.plot("x")
    with pytest.raises(ValueError, match="sine has conditions"):
        replace(found, conditions={"sine": {"hanging_mass_kg": 0.2}}).plot("sine")
    written = found.folder
    assert written.is_dir()
    del found
    gc.collect()
    assert not written.exists()
    assert list(folder.iterdir()) == []


def test_out_keeps_what_arrays_come_to() -> None:
    runs = rig.record({})
    found = smam.diagnose(runs, scene="muscle_bench", holdout=["chirp"], out="kept")
    assert found.verdict == "adequate"
    # The same from the folder that was written.
    again = smam.diagnose("kept/recordings", out="again")
    assert again.raw["effects"] == found.raw["effects"]
    assert again.channels.equals(found.channels)


def test_one_run_is_compared_with_its_scene() -> None:
    run = rig.record({})["sine"]
    beside = smam.compare(run, scene="muscle_bench", noise=rig.NOISE)
    assert list(beside.channels.index) == [("run.csv", column) for column in rig.NOISE]
    assert beside.channels.loc[("run.csv", "elongation_mm"), "rmse"] == pytest.approx(0.02, rel=0.15)
    arrays = {"time_s": run.index.to_numpy(), **{column: run[column].to_numpy() for column in run.columns}}
    assert smam.compare(arrays, scene="muscle_bench", noise=rig.NOISE).channels.equals(beside.channels)
    assert "srcdoc" in (beside._repr_html_() or "")


def test_a_loop_and_what_the_plunger_has_to_do() -> None:
    found = smam.identify(smam.run("muscle_printed_model"), "paper")
    assert found.models.loc["paper", "f_mm2"] < 1e-3
    wanted = {"time_s": np.linspace(0.0, 4.0, 201), "elongation_mm": 5.0 - 5.0 * np.cos(np.linspace(0.0, 2.0 * np.pi, 201))}
    programme = smam.feedforward(found.tables["paper"], wanted, most_mm=2.0)
    assert programme.index.name == "time_s"
    assert 0.0 <= programme["plunger_mm"].min() and programme["plunger_mm"].max() <= 2.0
    assert np.abs(programme["expected_mm"].to_numpy() - wanted["elongation_mm"]).max() < 0.1


def test_laws_of_a_scene_run_with_another() -> None:
    parameter = {"force_n": {"value": 0.05, "unit": "N"}}
    law = {"name": "drag", "port": "muscle.damping", "adds": "force_n*tanh(speed_m_s/2e-3)", "parameter": parameter}
    subprocess.run([find_program(), "scenes", "muscle_bench", "--copy-to", "."], check=True, capture_output=True)
    scene = Path("scenes/muscle_bench.toml").rename("scenes/mine.toml")
    text = scene.read_text(encoding="utf-8") + "\n" + document({"law": [law]})
    scene.write_text(text, encoding="utf-8")
    assert laws_of_scene(scene) == [law]
    assert smam.run(scene).equals(smam.run("muscle_bench", laws=laws_of_scene(scene)))


@pytest.mark.parametrize(
    ("recordings", "more", "message"),
    [
        ({"time_s": [0.0, 1.0], "plunger_mm": [0.0, 1.0]}, {}, "scene: arrays do not name theirs"),
        ({"time_s": [0.0, 1.0], "foo_mm": [0.0, 1.0]}, {"scene": "muscle_bench"}, "no column drives the scene: its inputs are plunger_mm; found: foo_mm"),
        ({"time_s": [0.0, 1.0], "plunger_mm": [0.0, 1.0]}, {"scene": "muscle_bench"}, "no column is compared: the scene shows elongation_mm"),
        ({"plunger_mm": [0.0, 1.0]}, {"scene": "muscle_bench"}, 'there is no "time_s" among plunger_mm'),
        ({}, {"scene": "muscle_bench"}, "no runs given"),
        ("folder", {"noise": {"elongation_mm": 0.02}}, "noise: is for arrays"),
        (
            {"time_s": [0.0, 1.0], "plunger_mm": [0.0, 1.0], "elongation_mm": [0.0, 1.0]},
            {"scene": "muscle_bench", "noise": {"force_n": 0.1}},
            "noise: there is no column force_n; found: plunger_mm, elongation_mm",
        ),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_said(recordings: object, more: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message.replace("(", r"\(")):
        smam.diagnose(recordings, **more)  # type: ignore[arg-type]
