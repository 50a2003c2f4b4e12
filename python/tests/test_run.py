"""Runs and lists: frames with the right columns, and errors with their remedy."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import smam


def test_a_run_is_a_frame_over_time() -> None:
    shown = smam.run("muscle_bench", duration_s=10.0)
    assert shown.index.name == "time_s"
    assert shown.index.is_monotonic_increasing
    assert shown.index[-1] == 10.0
    assert list(shown.columns) == ["plunger_mm", "elongation_mm", "pressure_kpa", "force_n"]
    # One stroke of 3 mm: the muscle's bore is 17 times narrower than the syringe's.
    assert 26.0 < np.ptp(shown["elongation_mm"]) < 29.0
    assert 1900.0 < shown["pressure_kpa"].max() < 2300.0


def test_nothing_is_left_where_nothing_was_asked_for(folder: Path) -> None:
    smam.run("muscle_bench", duration_s=0.1)
    assert not list(folder.iterdir())


def test_arrays_drive_a_run_at_their_own_times() -> None:
    time_s = np.array([0.0, 0.5, 1.5, 2.0])
    plunger_mm = np.array([0.0, 1.0, 1.0, 0.25])
    of_arrays = smam.run("muscle_bench", input={"time_s": time_s, "plunger_mm": plunger_mm})
    assert of_arrays.index.tolist() == time_s.tolist()
    assert of_arrays["plunger_mm"].tolist() == pytest.approx(plunger_mm.tolist())
    of_frame = smam.run("muscle_bench", input=of_arrays[["plunger_mm"]])
    pd.testing.assert_frame_equal(of_arrays, of_frame)
    of_arrays.to_csv("drive.csv")
    pd.testing.assert_frame_equal(of_arrays, smam.run("muscle_bench", input="drive.csv", output="kept here.csv"))
    assert Path("kept here.csv").is_file()


def test_keys_numbers_lists_and_words_can_be_set() -> None:
    stiffer = smam.run("muscle_bench", duration_s=5.0, set={"muscles.tube.coil.stiffness_n_m": np.float64(60)})
    lift = {"kind": "points", "time_s": np.array([0.0, 5.0]), "value_m": (0.0, 1e-3)}
    slower = smam.run("muscle_bench", duration_s=5.0, set={"input.0.program": lift, "muscles.tube.wall": "unilateral"})
    usual = smam.run("muscle_bench", duration_s=5.0)
    assert stiffer["pressure_kpa"].max() > 1.2 * usual["pressure_kpa"].max()
    assert slower["plunger_mm"].iloc[-1] == pytest.approx(1.0)


def test_laws_of_your_own_act() -> None:
    usual = smam.run("muscle_bench", duration_s=5.0)
    short = smam.run("muscle_bench", duration_s=5.0, laws=["muscle.pull adds 20.0*elongation_m"])
    table = {"name": "stiffer", "port": "muscle.pull", "adds": "k_n_m*elongation_m", "parameter": {"k_n_m": {"value": 20.0}}}
    as_table = smam.run("muscle_bench", duration_s=5.0, laws=[table])
    pd.testing.assert_frame_equal(short, as_table)
    assert short["pressure_kpa"].max() > 1.05 * usual["pressure_kpa"].max()
    twice = smam.run("muscle_bench", duration_s=5.0, laws=[table], set={"law.stiffer.k_n_m": 40.0})
    assert twice["pressure_kpa"].max() > 1.05 * short["pressure_kpa"].max()


def test_a_wrong_law_is_refused_with_the_remedy() -> None:
    with pytest.raises(smam.SmamError, match="muscle.friction scales 1 \\+ speed_m_s") as raised:
        smam.run("muscle_bench", laws=["muscle.friction scales 1 + speed_m_s"])
    assert raised.value.exit_code == 2
    for wrong in (["muscle.friction 1.5"], [{"port": "muscle.friction", "scales": "1.5"}]):
        with pytest.raises(ValueError, match="remedy: write 'PORT adds EXPRESSION'"):
            smam.run("muscle_bench", laws=wrong)
    with pytest.raises(TypeError, match="not a list"):
        smam.run("muscle_bench", laws="muscle.friction scales 1.5")


def test_a_law_s_parameter_can_be_swept() -> None:
    law = {"name": "mine", "port": "muscle.friction", "scales": "1 + a", "parameter": {"a": {"value": 0.0}}}
    table = smam.sweep(
        "muscle_bench", {"law.mine.a": [0.0, 1.0]}, {"top_kpa": "max(pressure_kpa)"}, laws=[law], duration_s=6.0
    )
    assert table["top_kpa"].is_monotonic_increasing


def test_an_unknown_key_is_named_with_the_remedy(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(smam.SmamError) as raised:
        smam.run("muscle_bench", set={"muscles.friktion.m0_n": 0.1})
    assert "muscles.friktion" in str(raised.value)
    assert raised.value.exit_code == 2
    assert raised.value.remedy == "`smam check SCENE --keys` lists the keys of the scene"
    # Said once, by the exception.
    assert "friktion" not in capfd.readouterr().err
    assert "muscles.friction.m0_n" in smam.keys("muscle_bench").index


def test_a_length_that_is_none_is_refused_with_the_remedy() -> None:
    with pytest.raises(smam.SmamError, match="--duration -1: must be > 0") as raised:
        smam.run("muscle_bench", duration_s=-1)
    assert raised.value.remedy == "give the length of the run in seconds"


def test_notes_of_the_program_pass_through(capsys: pytest.CaptureFixture[str]) -> None:
    smam.run("muscle_bench", duration_s=0.2)
    said = capsys.readouterr().err
    assert "muscle_bench: 0.200 s simulated in" in said
    assert "smam_" not in said, "the scratch folder is nobody's business"


def test_times_are_asked_for() -> None:
    with pytest.raises(ValueError, match='no "time_s" among plunger_mm'):
        smam.run("muscle_bench", input={"plunger_mm": [0.0, 1.0]})


def test_scenes_and_effects_are_listed() -> None:
    scenes = smam.scenes()
    assert {"muscle_bench", "bending_catheter"} <= set(scenes["name"])
    assert scenes["title"].str.len().min() > 10
    effects = smam.effects()
    # A name may have several laws, a row each: a leak of fluid, and three of gas.
    leaks = effects[effects["name"] == "leak"]
    assert set(leaks["element"]) == {"line"}
    assert leaks["title"].is_unique


def test_a_sweep_has_a_row_per_point(folder: Path) -> None:
    table = smam.sweep(
        "muscle_bench",
        vary={"muscles.friction.m0_n": np.linspace(0.05, 0.25, 3)},
        measure={"range_mm": "range(elongation_mm)", "loss_mj": "1000 * loss(muscle)"},
        duration_s=20.0,
        out="swept",
    )
    warnings = [f"warning_{kind}_s" for kind in ("slack", "cavitation", "yield", "penetration", "joint_limit")]
    assert list(table.columns) == ["muscles.friction.m0_n", "range_mm", "loss_mj", *warnings, "error"]
    assert table["muscles.friction.m0_n"].tolist() == pytest.approx([0.05, 0.15, 0.25])
    # More friction: less motion, more loss.
    assert table["range_mm"].is_monotonic_decreasing
    assert table["loss_mj"].is_monotonic_increasing
    assert (table["error"] == "").all()
    again = smam.sweep(folder / "swept" / "sweep.toml", out="swept again")
    pd.testing.assert_frame_equal(table, again)


def test_a_sweep_takes_samples_and_changed_keys() -> None:
    table = smam.sweep(
        "muscle_bench",
        vary={"tube_c1_pa": {"from": 0.2e6, "to": 0.3e6}},
        measure={"pressure_max_kpa": "max(pressure_kpa)"},
        sampling={"method": "sobol", "count": 4, "seed": 1},
        set={"muscles.damping_n_s_m": 0.2},
        duration_s=5.0,
    )
    assert len(table) == 4
    assert table["tube_c1_pa"].between(0.2e6, 0.3e6).all()
    by_stiffness = table.sort_values("tube_c1_pa")
    assert by_stiffness["pressure_max_kpa"].is_monotonic_increasing


def test_a_wrong_measure_is_named() -> None:
    with pytest.raises(smam.SmamError, match=r"elongation_m\b.*did you mean") as raised:
        smam.sweep("muscle_bench", {"muscles.friction.m0_n": [0.1]}, {"range_mm": "range(elongation_m)"})
    assert raised.value.remedy is not None
