"""Recordings: diagnosed, compared, identified."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import rig

import smam
from smam._diagnose import _read

LEAK = {"name": "leak", "element": "line", "conductance_m3_s_pa": 5e-18}


def test_a_hidden_leak_is_named(folder: Path) -> None:
    rig.write({"effect": [LEAK], "muscles.friction.m0_n": 0.115}, "leaky rig")
    found = smam.diagnose("leaky rig")
    assert found.verdict == "missing_physics"
    assert "leak" in found.summary
    assert found.folder == folder / "out" / "diagnose_leaky rig"
    assert found.effects["name"].tolist() == ["leak"]
    leak = found.effects.iloc[0]
    assert (leak["element"], leak["parameter"]) == ("line", "conductance_m3_s_pa")
    assert leak["probability"] > 0.9
    assert leak["value"] == pytest.approx(5e-18, rel=0.05)
    assert leak["ci95_low"] < leak["value"] < leak["ci95_high"]
    assert 0.9 < found.gap_closed < 1.1
    elongation = found.channels.loc["elongation_mm"]
    assert elongation["rmse_corrected"] < 0.025 < elongation["rmse_baseline"]
    assert found.raw["fit"]["holdout"] == ["chirp.csv"]
    assert found.report is not None and "leak" in found.report.read_text(encoding="utf-8")
    # The corrected scene runs; on the held-out run it leaves the noise.
    assert found.scene is not None
    after = smam.run(found.scene, input="leaky rig/chirp.csv")
    measured = pd.read_csv("leaky rig/chirp.csv", index_col="time_s")
    left_mm = measured["elongation_mm"] - after["elongation_mm"]
    assert np.sqrt(np.mean(left_mm**2)) == pytest.approx(0.02, rel=0.15)


def test_a_bench_that_lacks_nothing_is_adequate() -> None:
    rig.write({}, "sound")
    found = smam.diagnose("sound", out="answer")
    assert found.verdict == "adequate"
    assert found.effects.empty
    assert "conductance_m3_s_pa" not in found.effects["parameter"].tolist()


def test_data_that_cannot_be_diagnosed_are_a_verdict() -> None:
    time_s = np.arange(0.0, 20.0, 0.02)
    still = {"time_s": time_s, "plunger_mm": 0.0 * time_s, "elongation_mm": np.random.default_rng(1).normal(0, 0.02, 1000)}
    smam.write_recordings("still", "muscle_bench", {"a": still, "b": still}, inputs=["plunger_mm"], outputs=["elongation_mm"])
    found = smam.diagnose("still")
    assert found.verdict == "unusable_data"
    assert found.effects.empty


def test_a_folder_without_recordings_is_an_error() -> None:
    with pytest.raises(smam.SmamError, match=r"recordings\.toml") as raised:
        smam.diagnose("nowhere")
    assert raised.value.exit_code == 2


def test_a_run_without_a_declared_column_is_refused() -> None:
    with pytest.raises(ValueError, match="run a: there is no column elongation_mm; found: plunger_mm"):
        smam.write_recordings(
            "x", "muscle_bench", {"a": {"time_s": [0.0], "plunger_mm": [0.0]}}, inputs=["plunger_mm"], outputs=["elongation_mm"]
        )


def test_an_output_that_one_run_lacks_is_written_as_such() -> None:
    short = {"time_s": [0.0, 0.1], "plunger_mm": [0.0, 0.1], "elongation_mm": [0.0, 0.9]}
    folder = smam.write_recordings(
        "mixed",
        "muscle_bench",
        {"a": {**short, "force_n": [0.0, 0.1]}, "b": short},
        inputs=["plunger_mm"],
        outputs=["elongation_mm", "force_n"],
    )
    text = (folder / "recordings.toml").read_text(encoding="utf-8")
    assert text.count("not_recorded") == 1
    assert 'not_recorded = ["force_n"]' in text.split("b.csv")[1]
    assert "force_n" not in (folder / "b.csv").read_text(encoding="utf-8")


def test_measured_beside_simulated() -> None:
    rig.write({"effect": [LEAK]}, "leaky")
    beside = smam.compare("leaky")
    assert set(beside.channels.index) == {(f"{run}.csv", column) for run in ("sine", "steps", "chirp") for column in rig.NOISE}
    assert beside.channels.loc[("sine.csv", "elongation_mm"), "rmse"] > 0.03
    repaired = smam.compare("leaky", set={"effect": [LEAK]}, out="repaired")
    assert repaired.channels.loc[("sine.csv", "elongation_mm"), "rmse"] == pytest.approx(0.02, rel=0.15)
    assert repaired.page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_a_loop_is_identified() -> None:
    smam.run("muscle_printed_model", output="loop.csv")
    found = smam.identify("loop.csv", ["paper", "asymmetric"])
    assert found.models.index.tolist() == ["paper", "asymmetric"]
    # The loop was drawn by the paper's model.
    assert found.models.loc["paper", "f_mm2"] < 1e-3
    assert found.parameters.loc[("paper", "n"), "half_width_95"] > 0.0
    assert "displacement" in found.tables["paper"].read_text(encoding="utf-8")
    assert found.page.is_file()


def test_forms_and_specimens_of_an_answer_are_tables(folder: Path) -> None:
    estimate = {"value": 0.1, "ci95": [0.09, 0.11]}
    form = {"port": "muscle.coil", "acts": "scales", "law": "1 + 2 * time_s/30", "score_difference": 0.5}
    law = {
        "name": "muscle_wall", "element": "muscle", "probability": 1.0, "parameters": {"a": estimate}, "port": "muscle.wall", "acts": "scales",
        "law": "1 - 0.1 * time_s/30", "known_as": "stress relaxation", "hypothetical": True, "forms": [form],
    }  # fmt: skip
    answer = {
        "verdict": "unknown_physics",
        "effects": [law],
        "specimens": {"tube_c1_pa": {"values": {"old": estimate, "new": estimate}, "differs": False}},
    }
    (folder / "diagnosis.json").write_text(json.dumps(answer), encoding="utf-8")
    found = _read(folder)
    assert found.effects.iloc[0][["port", "acts", "known_as"]].tolist() == ["muscle.wall", "scales", "stress relaxation"]
    assert found.forms.iloc[0][["of", "port", "known_as"]].tolist() == ["muscle_wall", "muscle.coil", ""]
    assert found.specimens["specimen"].tolist() == ["old", "new"]
    assert not found.specimens["differs"].any()
