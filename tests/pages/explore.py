"""What a reader does on a page; each function takes a page that is watched and says there what does not hold."""

import csv
import re
import shlex
import subprocess

# Numbers of shown figures whose canvas has no pixel, or that have none.
BLANK_FIGURES = """() => [...document.querySelectorAll("figure.chart")].filter(figure => !figure.hidden).filter(figure => {
  const canvases = [...figure.querySelectorAll("canvas")];
  const isBlank = canvas => !canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some(value => value > 0);
  return canvases.length === 0 || canvases.some(canvas => canvas.width > 0 && isBlank(canvas));
}).map(figure => figure.dataset.figure)"""


# Whether a table goes on beyond its box without a shadow that says so.
CUT_TABLES = """() => [...document.querySelectorAll("div:has(> table)")].some(box =>
  box.scrollWidth > box.clientWidth + 1 && !getComputedStyle(box).backgroundAttachment.includes("local"))"""


def shown_figure(page, which=0):
    """The first (or another) figure with a plot that is not hidden."""
    return page.locator("figure:not([hidden]):not(:has(figure)):has(.u-over)").nth(which)


def over(page, which=0):
    """Box of that figure's first plot."""
    plot = shown_figure(page, which).locator(".u-over").first
    plot.scroll_into_view_if_needed()
    return plot.bounding_box()


def read_at(page, share, height=0.5, which=0):
    """What is read with the cursor at a share of the width."""
    box = over(page, which)
    page.mouse.move(box["x"] + share * box["width"], box["y"] + height * box["height"])
    page.wait_for_timeout(60)
    return shown_figure(page, which).locator(".readout").first.inner_text()


def read_anywhere(page):
    """What is read at the first place where there is something: of loops and points the cursor must be near one."""
    for height in (0.5, 0.3, 0.7, 0.1, 0.9):
        for share in (0.5, 0.3, 0.7, 0.05, 0.95):
            if words := read_at(page, share, height):
                return words
    return ""


def first_number(words):
    found = re.search(r"-?\d+(\.\d+)?(e[-+]?\d+)?", words)
    return float(found[0]) if found else None


def cursor_reads(watched):
    words = read_anywhere(watched.page)
    watched.expect(first_number(words) is not None, f"the cursor reads '{words}'")


def drag(page, start, end):
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1]))
    page.mouse.move(*end)
    page.mouse.up()
    page.wait_for_timeout(120)


def zoom_and_back(watched, which=0):
    """Of a figure whose lines run to the right."""
    page = watched.page
    at_left = lambda: first_number(read_at(page, 0.02, which=which))
    left = at_left()
    box = over(page, which)
    middle = box["y"] + 0.5 * box["height"]
    drag(page, (box["x"] + 0.4 * box["width"], middle), (box["x"] + 0.8 * box["width"], middle))
    zoomed = at_left()
    shown_figure(page, which).get_by_role("button", name="whole", exact=True).click()
    page.wait_for_timeout(120)
    again = at_left()
    watched.expect(None not in (left, zoomed) and zoomed > left, f"zoom: {left} at the left, then {zoomed}")
    watched.expect(again == left, f"the whole again: {left} at the left, then {again}")


def lines_off_and_on(watched):
    page = watched.page
    picture = lambda: shown_figure(page).locator("canvas").first.evaluate("canvas => canvas.toDataURL()")
    key = shown_figure(page).locator(".key:enabled").last
    page.mouse.move(0, 0)
    pictures = [picture()]
    for pressed in ("false", "true"):
        key.click()
        page.mouse.move(0, 0)
        page.wait_for_timeout(80)
        pictures.append(picture())
        watched.expect(key.get_attribute("aria-pressed") == pressed, f"a line's key is not {pressed}")
    watched.expect(pictures[0] != pictures[1] and pictures[0] == pictures[2], "a line does not go and come back")


def chooser(watched):
    page = watched.page
    shown = []
    for end in ("first", "last"):
        for axis in ("run", "channel"):
            getattr(page.locator(f".chooser [data-axis={axis}]"), end).click()
            page.wait_for_timeout(150)
        shown.append(shown_figure(page).get_attribute("data-figure"))
    watched.expect(shown[0] != shown[1], "another run and channel show the same figure")
    watched.expect(page.locator(".chooser figure:not([hidden])").count() == 1, "the chooser shows more than one figure")
    cursor_reads(watched)


def csv_is_what_was_recorded(watched, recorded):
    """The CSV of the first run and channel holds the samples as they were recorded."""
    page = watched.page
    for axis in ("run", "channel"):
        page.locator(f".chooser [data-axis={axis}]").first.click()
    page.wait_for_timeout(150)
    with page.expect_download() as download:
        shown_figure(page).get_by_role("link", name="CSV").click()
    with open(download.value.path(), newline="") as lines:
        saved = list(csv.DictReader(lines))
    with open(recorded, newline="") as lines:
        rows = list(csv.DictReader(lines))
    column = page.locator(".chooser [data-axis=channel]").first.inner_text()
    numbers = lambda table, name: [float(row[name]) if row[name] else None for row in table]
    worst_s = max((abs(a - b) for a, b in zip(numbers(saved, "time_s"), numbers(rows, "time_s"))), default=1)
    watched.expect(len(saved) == len(rows) and worst_s < 1e-9, "times in the CSV are not those of the recording")
    watched.expect(numbers(saved, "measured") == numbers(rows, column), "values in the CSV are not those of the recording")


def marked_stretches(watched):
    page = watched.page
    marks = page.locator(".lane [data-from]")
    watched.expect(marks.count() > 0, "no stretch is marked")
    mark = marks.last
    mark.evaluate("mark => mark.click()")
    page.wait_for_timeout(900)
    at = first_number(read_at(page, 0.5))
    start, end = (float(mark.get_attribute(f"data-{name}")) for name in ("from", "to"))
    watched.expect(at is not None and start <= at <= end, f"a mark of {start} to {end} s shows {at} s in the middle")


def folds(watched):
    page = watched.page
    table = page.locator("details table").first
    watched.expect(not table.is_visible(), "the numbers are not folded")
    page.locator("summary").first.click()
    watched.expect(table.is_visible(), "the numbers do not unfold")


def shown_count(page):
    return int(re.match(r"(\d+) of", page.locator(".points + p").inner_text())[1])


def sorting_and_filters(watched):
    page = watched.page
    button = page.locator(".points thead button").last
    cells = page.locator(".points tbody tr td:last-child")
    for way in (1, -1):
        button.click()
        values = [float(text) for text in cells.all_inner_texts()]
        watched.expect(values == sorted(values, reverse=way < 0), "the table is not sorted")
    whole = shown_count(page)
    field = page.locator(".points input").last
    field.fill(f">= {values[len(values) // 2]}")
    kept = [float(text) for text in cells.all_inner_texts()]
    watched.expect(0 < shown_count(page) < whole and min(kept) >= values[len(values) // 2], "the filter keeps what it must not")
    field.fill("")
    watched.expect(shown_count(page) == whole, "without a filter not all points are there")


def parallel_axes(watched):
    page = watched.page
    whole = shown_count(page)
    axes = page.locator("canvas.parallel")
    axes.scroll_into_view_if_needed()
    box = axes.bounding_box()
    x = box["x"] + 46
    drag(page, (x, box["y"] + 150), (x, box["y"] + 245))
    part = shown_count(page)
    watched.expect(0 < part < whole, f"a stretch on an axis keeps {part} of {whole} points")
    page.get_by_role("button", name="all points again").click()
    watched.expect(shown_count(page) == whole, "not all points come back")


def command_runs(watched, smam, folder):
    page = watched.page
    page.locator(".points tbody tr").first.click()
    command = page.locator(".command").inner_text()
    words = shlex.split(command)
    watched.expect(words[:2] == ["smam", "run"] and "--set" in words, f"a point's command is '{command}'")
    done = subprocess.run([smam, *words[1:], "--output", "point.csv"], cwd=folder, capture_output=True, text=True)
    watched.expect(done.returncode == 0, f"a point's command fails: {done.stderr}")


def map_reads(watched):
    page = watched.page
    figure = page.locator("figure:not(:has(figure)):has(.scale)").first
    figure.scroll_into_view_if_needed()
    box = figure.locator(".u-over").bounding_box()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    page.wait_for_timeout(60)
    words = figure.locator(".readout").inner_text()
    watched.expect(len(re.findall(r"\d", words)) > 2 and words.count("·") == 2, f"the map reads '{words}'")


def keys_change(watched):
    page = watched.page
    label = page.locator(".choices [data-key]").last
    label.click()
    watched.expect(label.get_attribute("aria-pressed") == "true", "another key is not chosen")
    cursor_reads(watched)
