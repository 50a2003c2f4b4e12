#!/usr/bin/env python3
"""Makes the pictures of docs/gallery.md again: each scene, run as long as its caption says, in the headless viewer.

    VENV/bin/python docs/make_gallery.py target/release/smam [SCENE ...]

VENV holds rerun-sdk of the version that Cargo.toml pins, and pillow. Debian's mesa-vulkan-drivers draws where there is no graphics card.
"""

import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from PIL import Image
from rerun.experimental import ViewerClient

HERE = Path(__file__).parent
PORT = 9712
SIZE = (1600, 900)
# The viewer's own bar, at the top.
BAR = 28
# By then it has loaded the file, and its remarks about the renderer are gone.
SETTLED_S = 16


def captions():
    """Scene -> seconds, as the page says."""
    text = (HERE / "gallery.md").read_text()
    parts = re.split(r"^## `(\w+)`$", text, flags=re.MULTILINE)[1:]
    return {name: float(re.search(r"--duration ([\d.]+)", part)[1]) for name, part in zip(parts[::2], parts[1::2])}


def picture(smam, scene, seconds, folder):
    """What the viewer shows at the end of a run."""
    rrd, png = folder / f"{scene}.rrd", folder / f"{scene}.png"
    run = [smam, "run", scene, "--duration", str(seconds), "--output", str(folder / "run.csv"), "--rrd", str(rrd)]
    subprocess.run(run, check=True, capture_output=True)
    rerun = Path(sys.executable).parent / "rerun"
    size = f"{SIZE[0]}x{SIZE[1]}"
    viewer = subprocess.Popen([rerun, rrd, "--headless", "--window-size", size, "--port", str(PORT)], stderr=subprocess.DEVNULL)
    try:
        time.sleep(SETTLED_S)
        ViewerClient(f"127.0.0.1:{PORT}").save_screenshot(str(png))
        time.sleep(2)
    finally:
        viewer.terminate()
        viewer.wait()
    return Image.open(png).convert("RGB").resize(SIZE, Image.LANCZOS).crop((0, BAR, *SIZE))


def main():
    smam, wanted = sys.argv[1], sys.argv[2:]
    for scene, seconds in captions().items():
        if wanted and scene not in wanted:
            continue
        with tempfile.TemporaryDirectory() as folder:
            image = picture(smam, scene, seconds, Path(folder))
        file = HERE / "images" / "gallery" / f"{scene}.png"
        image.quantize(96, dither=Image.Dither.NONE).save(file, optimize=True)
        print(f"{file}: {file.stat().st_size // 1000} kB")


if __name__ == "__main__":
    main()
