"""Draws the pictures of this folder anew: `python docs/pictures.py`, in an environment with dcg_torch."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from PIL import Image, ImageDraw

from dcg_torch.experiment.recording.paint import INK, PAPER, font
from dcg_torch.simulator.screenshot import close_up, world_screenshot
from dcg_torch.storage.resources import resource
from dcg_torch.world.files import load_worlds
from dcg_torch.world.generator import TYPES

PICTURES = Path(__file__).parent / "pictures"
COLORS = ("red", "green", "blue")


def contact_sheet(pictures: Sequence[tuple[str, Image.Image]], columns: int) -> Image.Image:
    """Pictures of one size in rows, each with a line of text under it."""
    width, height = pictures[0][1].size
    rows = -(-len(pictures) // columns)
    sheet = Image.new("RGB", (columns * (width + 8) + 8, rows * (height + 30) + 8), PAPER)
    draw = ImageDraw.Draw(sheet)
    for k, (text, picture) in enumerate(pictures):
        x, y = 8 + k % columns * (width + 8), 8 + k // columns * (height + 30)
        sheet.paste(picture, (x, y))
        draw.text((x + width / 2, y + height + 12), text, font=font(14), fill=INK, anchor="mm")
    return sheet


def save(image: Image.Image, name: str) -> None:
    """As PNG of few colours, which halves the file."""
    image.quantize(256, dither=Image.Dither.NONE).save(PICTURES / name, optimize=True)


def main() -> None:
    """Types, worlds, a pair of world and object, the laboratory, and a figure of the paper's experiment."""
    PICTURES.mkdir(exist_ok=True)
    types = [(t, Image.fromarray(close_up(t, COLORS[k % 3], 220))) for k, t in enumerate(TYPES)]
    save(contact_sheet(types, columns=4), "types.png")
    worlds = load_worlds(resource("worlds"))
    pictures = [(world.name, Image.fromarray(world_screenshot(world, None, (300, 225)))) for world in worlds]
    save(contact_sheet(pictures, columns=5), "worlds.png")
    save(Image.fromarray(world_screenshot(worlds[4], "red_traffic_cone")), "pair.png")
    with tempfile.TemporaryDirectory() as directory:
        for experiment, made, name in (
            ("hardware", "animations/trial_0000.gif", "hardware.gif"),
            ("paper", "figures/accuracy.png", "paper.png"),
        ):
            run = f"{directory}/{experiment}"
            command = [sys.executable, "-m", "dcg_torch", f"experiment={experiment}", f"hydra.run.dir={run}"]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            shutil.copy(Path(run) / made, PICTURES / name)


if __name__ == "__main__":
    main()
