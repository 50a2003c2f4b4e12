"""Shows that check_docs.py finds each kind of fault. Run: python3 -m unittest discover docs"""

import contextlib
import io
import os
import tempfile
import unittest
from pathlib import Path

import check_docs
from doc_pages import Page, read_page

ECHO = "#!/bin/sh\n[ \"$1\" = fail ] && exit 2\necho \"told: $*\"\n"


def page(text: str, name: str = "docs/page.md") -> Page:
    return read_page(name, text)


class WithFolder(unittest.TestCase):
    """A repository of its own with a program that repeats its arguments, and fails on `fail`."""

    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = Path(scratch.name)
        (self.root / "docs").mkdir()
        (self.root / "scenes").mkdir()
        (self.root / "scenes" / "one.toml").write_text("format = 1\n")
        self.smam = self.root / "smam"
        self.smam.write_text(ECHO)
        self.smam.chmod(0o755)

    def commands(self, text: str) -> tuple[list[str], str]:
        """Faults of a page's commands, and what was printed meanwhile."""
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            faults = check_docs.check_commands(self.root, [page(text)], self.smam, times=True)
        return [str(f) for f in faults], printed.getvalue()

    def links(self, text: str, later: tuple[str, ...] = (), name: str = "docs/page.md") -> list[str]:
        (self.root / name).write_text(text)
        return [str(f) for f in check_docs.check_links(self.root, [page(text, name)], set(later))]


class Links(WithFolder):
    def test_a_file_that_is_missing(self) -> None:
        self.assertEqual(self.links("# A\n\n[b](b.md)"), ["docs/page.md:3: b.md does not exist"])
        self.assertEqual(self.links("![b](images/b.png)"), ["docs/page.md:1: images/b.png does not exist"])
        self.assertEqual(self.links("<img src=\"b.png\">"), ["docs/page.md:1: b.png does not exist"])
        self.assertEqual(self.links("[b]: b.md"), ["docs/page.md:1: b.md does not exist"])

    def test_a_link_over_two_lines(self) -> None:
        self.assertEqual(self.links("one [two\nthree](b.md)"), ["docs/page.md:1: b.md does not exist"])

    def test_a_picture_with_a_link_of_its_own(self) -> None:
        self.assertEqual(len(self.links("[![b](b.png)](c.md)")), 1)

    def test_a_missing_anchor_names_those_that_are_there(self) -> None:
        faults = self.links("# What `compare` does\n\n## Twice\n\n## Twice\n\n[a](#nowhere) [b](#twice-1) [c](#what-compare-does)")
        self.assertEqual(faults, ["docs/page.md:7: #nowhere: there is no heading #nowhere (there are: twice, twice-1, what-compare-does)"])

    def test_an_anchor_of_another_page(self) -> None:
        (self.root / "docs" / "b.md").write_text("# Here\n")
        self.assertEqual(self.links("[b](b.md#here)"), [])
        self.assertEqual(len(self.links("[b](b.md#there)")), 1)

    def test_a_page_of_the_book_stays_in_the_book(self) -> None:
        (self.root / "ARCHITECTURE.md").write_text("# A\n")
        self.assertIn("outside docs/", self.links("[a](../ARCHITECTURE.md)")[0])
        self.assertEqual(self.links("[a](docs/page.md)", name="README.md"), [])
        self.assertIn("out of the repository", self.links("[a](../../etc)")[0])

    def test_what_is_no_link(self) -> None:
        self.assertEqual(self.links("`[a](b.md)`\n\n```sh\n[a](b.md)\n```\n\n[web](https://example.org)"), [])

    def test_a_page_that_the_book_does_not_list(self) -> None:
        (self.root / "docs" / "SUMMARY.md").write_text("- [A](a.md)\n")
        (self.root / "docs" / "a.md").write_text("# A\n")
        self.assertEqual(check_docs.check_contents(self.root), [])
        (self.root / "docs" / "b.md").write_text("# B\n")
        self.assertEqual([f.text for f in check_docs.check_contents(self.root)], ["does not list b.md: add a line for it"])

    def test_a_guide_that_nobody_reads_to_its_end(self) -> None:
        (self.root / "README.md").write_text("word " * 9_000)
        (self.root / "docs" / "a.md").write_text("word " * 6_001)
        table = self.root / "docs" / "SUMMARY.md"
        table.write_text("# User guide\n\n- [a](a.md)\n")
        self.assertIn("15001 words", check_docs.check_length(self.root)[0].text)
        table.write_text("# User guide\n\n# Reference\n\n- [a](a.md)\n")
        self.assertEqual(check_docs.check_length(self.root), [])
        table.write_text("- [a](a.md)\n")
        self.assertEqual(len(check_docs.check_length(self.root)), 1)

    def test_a_page_that_comes_later(self) -> None:
        self.assertEqual(self.links("[b](b.md)", later=("docs/b.md",)), [])


class Data(unittest.TestCase):
    def faults(self, text: str) -> list[str]:
        return [str(f) for f in check_docs.check_data([page(text)])]

    def test_data_that_cannot_be_read(self) -> None:
        self.assertIn("docs/page.md:1: toml cannot be read", self.faults("```toml\na = \n```")[0])
        self.assertIn("docs/page.md:1: json cannot be read", self.faults("```json\n{,}\n```")[0])
        self.assertEqual(self.faults("```toml,file=a.toml\na = 1\n```\n\n```json\n{}\n```"), [])

    def test_a_word_that_nobody_knows(self) -> None:
        self.assertIn("'nrun(slow)'", self.faults("```sh,nrun(slow)\nsmam\n```")[0])

    def test_an_exit_code_is_a_number(self) -> None:
        self.assertIn("'exit=two'", self.faults("```sh,exit=two\nsmam\n```")[0])

    def test_not_running_needs_a_reason(self) -> None:
        self.assertIn("'norun'", self.faults("```sh,norun\nsmam\n```")[0])
        self.assertIn("'norun()'", self.faults("```sh,norun()\nsmam\n```")[0])


class Commands(WithFolder):
    def test_a_command_that_fails(self) -> None:
        faults, _ = self.commands("# A\n\n```sh\nsmam run\nsmam fail\n```")
        self.assertEqual(len(faults), 1)
        self.assertIn("docs/page.md:5: exit code 2 instead of 0: smam fail", faults[0])

    def test_a_command_that_should_fail_and_does_not(self) -> None:
        self.assertEqual(self.commands("```sh,exit=2\nsmam fail\n```")[0], [])
        self.assertEqual(len(self.commands("```sh,exit=2\nsmam run\n```")[0]), 1)

    def test_a_failure_within_a_pipe(self) -> None:
        self.assertEqual(len(self.commands("```sh\nsmam fail | cat\n```")[0]), 1)

    def test_cargo_is_the_program_too(self) -> None:
        text = "```sh\ncargo run --release -- run a\n```\n\n```text,output\ntold: run a\n```"
        self.assertEqual(self.commands(text)[0], [])
        self.assertIn("127", self.commands("```sh\ncargo bench\n```")[0][0])

    def test_lines_comments_and_long_lines(self) -> None:
        _, printed = self.commands("```sh\n# only said\nsmam a \\\n    b\n\nsmam c # more\n```")
        self.assertEqual([line.split("  ")[-1] for line in printed.splitlines()], ["smam a b", "smam c # more"])

    def test_what_is_not_run_is_printed_with_its_reason(self) -> None:
        faults, printed = self.commands("```sh,norun(takes 4 minutes, or 5)\nsmam fail\n```")
        self.assertEqual(faults, [])
        self.assertIn("docs/page.md:1: takes 4 minutes, or 5", printed)

    def test_output_that_was_not_printed(self) -> None:
        shown = "```sh\nsmam a b\n```\n\n```text,output\n{}\n...\n```"
        self.assertEqual(self.commands(shown.format("told: a   b"))[0], [])
        self.assertEqual(self.commands(shown.format("told: ... b"))[0], [])
        self.assertEqual(self.commands(shown.format("told: a c"))[0], ["docs/page.md:6: was not printed: told: a c"])

    def test_output_without_a_command(self) -> None:
        self.assertEqual(len(self.commands("```text,output\ntold: a\n```")[0]), 1)

    def test_files_of_a_page_and_of_a_clone(self) -> None:
        self.assertEqual(self.commands("```csv,file=a/b.csv\nx\n```\n\n```sh\ngrep x a/b.csv\ntest -f scenes/one.toml\n```")[0], [])

    def test_each_page_has_a_folder_of_its_own(self) -> None:
        pages = [page("```sh\ntouch here\n```"), page("```sh\ntest ! -e here\n```")]
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(check_docs.check_commands(self.root, pages, self.smam, times=False), [])


@unittest.skipUnless("TYPOS" in os.environ, "TYPOS=PROGRAM says where typos is")
class Spelling(WithFolder):
    def test_a_word_that_is_wrong_and_one_that_is_american(self) -> None:
        (self.root / "a.md").write_text("It recieves a color.\n")
        faults = [str(f) for f in check_docs.check_spelling(self.root, ["a.md"], os.environ["TYPOS"])]
        self.assertEqual(faults, ["a.md:1: 'recieves' should be 'receives'", "a.md:1: 'color' should be 'colour'"])


if __name__ == "__main__":
    unittest.main()
