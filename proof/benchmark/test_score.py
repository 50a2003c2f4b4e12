"""Contract of the scorer: `python3 -m unittest discover proof/benchmark`."""

import contextlib
import io
import json
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

import answer_smam  # noqa: E402
import score  # noqa: E402

LAW = {"effect": None, "element": "muscle", "port": "muscle.coil", "variables": ["speed_m_s"]}
LEAK = {"effect": "leak", "element": "line", "port": None, "variables": []}
NOISE_SD = 0.5


class Scorer(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.benchmark, self.answers = Path(folder.name, "benchmark"), Path(folder.name, "answers")
        self.answers.mkdir()
        # A ramp; the calibrated scene is three noise standard deviations low throughout.
        self.hide("a", [LAW, LEAK], [1.0, 2.0, 3.0], [2.5, 3.5, 4.5])
        self.hide("b", [], [1.0, 1.0, 1.0], [1.5, 0.5, 1.5])

    def hide(self, name, causes, calibrated, measured):
        truth = {"case": name, "rig": "muscle_bench", "causes": causes, "noise_sd": {"elongation_mm": NOISE_SD}}
        for folder in ("truth", f"cases/{name}/next"):
            (self.benchmark / folder).mkdir(parents=True, exist_ok=True)
        (self.benchmark / "truth" / f"{name}.json").write_text(json.dumps(truth))
        self.columns(self.benchmark / "truth" / f"{name}.csv", measured)
        self.columns(self.benchmark / "cases" / name / "next" / "calibrated.csv", calibrated)

    def columns(self, path, values):
        path.write_text("time_s,elongation_mm\n" + "".join(f"{i},{v}\n" for i, v in enumerate(values)))

    def say(self, name, causes):
        answer = {"format": 1, "case": name, "causes": causes}
        (self.answers / f"{name}.json").write_text(json.dumps(answer))

    def run_it(self, *flags):
        words = ["score.py", str(self.benchmark), str(self.answers), *flags]
        out, err = io.StringIO(), io.StringIO()
        with mock.patch("sys.argv", words), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = score.main()
        return code, out.getvalue(), err.getvalue()

    def scored(self):
        code, out, err = self.run_it("--json")
        self.assertEqual((code, err), (0, ""))
        return json.loads(out)

    def test_no_answer_says_that_nothing_is_missing(self):
        result = self.scored()
        self.assertEqual([row["detected"] for row in result["cases"]], [False, True])
        self.assertEqual(result["all"]["certain_and_wrong"], 0)

    def test_causes_count_first_and_in_a_set_of_three(self):
        others = [{**LAW, "port": "muscle.wall"}, LAW, LEAK]  # the third alternative is one too many
        self.say("a", [{**LAW, "variables": ["time_s"], "probability": 0.95, "alternatives": others}])
        row = self.scored()["cases"][0]
        self.assertEqual((row["first"], row["in_set"], row["element"]), (0, 1, 1))
        self.assertEqual((row["said"], row["hidden"], row["certain_and_wrong"]), (1, 2, 1))

    def test_a_false_alarm_is_one(self):
        self.say("b", [{**LEAK, "probability": 0.5}])
        of_all = self.scored()["all"]
        self.assertEqual((of_all["false_alarms"], of_all["certain_and_wrong"]), (1, 0))

    def test_the_gap_is_that_between_the_calibrated_scene_and_the_noise(self):
        # Half a standard deviation off: 9 noise variances of the calibrated scene become 0.25.
        self.columns(self.answers / "a.csv", [2.25, 3.25, 4.25])
        self.assertAlmostEqual(self.scored()["cases"][0]["gap_closed"], (9.0 - 0.25) / (9.0 - 1.0))
        self.columns(self.answers / "a.csv", [1.0, 2.0, 3.0])
        self.assertAlmostEqual(self.scored()["cases"][0]["gap_closed"], 0.0)
        self.columns(self.answers / "a.csv", [0.0, 0.0, 0.0])
        self.assertEqual(self.scored()["all"]["worse_than_calibrated"], 1)

    def test_what_is_no_answer_is_refused_with_its_place(self):
        def refused(*parts):
            code, out, err = self.run_it()
            self.assertEqual((code, out), (2, ""))
            for part in (*parts, "remedy: "):
                self.assertIn(part, err)

        for text in ("{", "[]", '{"causes": [{"element": 3, "probability": 1}]}', '{"causes": [{"element": "line"}]}'):
            (self.answers / "a.json").write_text(text)
            refused("a.json")
        self.say("a", [{**LEAK, "probability": 1.5}])
        refused("a.json", "1.5")
        (self.answers / "a.json").write_text('{"case": "b", "causes": []}')
        refused("a.json", "'b'")
        self.say("a", [])
        self.columns(self.answers / "a.csv", [1.0])
        refused("a.csv", "3 rows of elongation_mm")
        (self.answers / "a.csv").write_text("time_s,elongation_mm\n0,x\n")
        refused("a.csv", "x")

    def test_a_folder_without_truth_is_refused(self):
        self.benchmark = self.answers
        code, _, err = self.run_it()
        self.assertEqual(code, 2)
        self.assertIn("truth", err)

    def test_the_table_has_a_row_for_each_case_and_a_line_for_all(self):
        _, out, _ = self.run_it()
        self.assertEqual(out.count("| muscle_bench |"), 2)
        self.assertIn("detected 0 of 1, false alarms 0 of 1", out)


class Answers(unittest.TestCase):
    def test_a_diagnosis_becomes_an_answer(self):
        effect = {"name": "leak", "element": "line_1", "rivals": ["sensor_gain on angle_deg"], "probability": 0.7}
        effect["forms"] = [
            {"port": "plunger_2", "law": "1e-3*time_s"},
            {"port": "sensor.angle_deg", "law": "2"},
            {"port": "joint.torque", "law": "abs(speed_rad_s)*angle_rad"},
        ]
        gain = {"name": "sensor_gain", "element": "sensor", "channel": "angle_deg", "rivals": [], "probability": 0.3}
        law = {"name": "coil", "element": "muscle", "port": "muscle.coil", "variables": ["time_s"], "law": "time_s"}
        law.update(rivals=[], probability=1.0, hypothetical=True)
        said = answer_smam.causes({"effects": [gain, effect, law]})
        self.assertEqual([cause["element"] for cause in said], ["muscle", "line_1"])
        self.assertEqual((said[0]["effect"], said[0]["port"]), (None, "muscle.coil"))
        others = [(other["element"], other.get("variables")) for other in said[1]["alternatives"]]
        expected = [("angle_deg", None), ("syringe_2", ["time_s"]), ("angle_deg", [])]
        self.assertEqual(others, [*expected, ("mechanism", ["angle_rad", "speed_rad_s"])])

    def test_answers_keep_to_the_schema_that_others_are_given(self):
        schema = json.loads((HERE / "answer.schema.json").read_text())
        self.assertEqual(schema["required"], ["format", "case", "causes"])
        known = set(schema["$defs"]["cause"]["properties"]) | set(schema["properties"]["causes"]["items"]["properties"])
        law = {"name": "coil", "element": "muscle", "port": "muscle.coil", "variables": [], "law": "1"}
        law.update(rivals=[], probability=1.0, hypothetical=True, forms=[{"port": "muscle.pull", "law": "1"}])
        for cause in answer_smam.causes({"effects": [law]}):
            self.assertLessEqual(set(cause), known)
            self.assertLessEqual(set(cause["alternatives"][0]), known)


if __name__ == "__main__":
    unittest.main()
