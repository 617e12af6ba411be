"""Colours, letters and small drawings that the panels of an animation share."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Final

import matplotlib
from PIL import Image, ImageDraw, ImageFont

RGB = tuple[int, int, int]
Draw = ImageDraw.ImageDraw

PAPER: Final[RGB] = (252, 252, 250)
INK: Final[RGB] = (30, 30, 34)
GREY: Final[RGB] = (125, 125, 128)
KNOWN: Final[RGB] = (0, 104, 170)
UNKNOWN: Final[RGB] = (214, 110, 0)
CHOICE: Final[RGB] = (255, 196, 0)
RIM: Final[RGB] = (60, 40, 0)
RIGHT: Final[RGB] = (0, 140, 95)
WRONG: Final[RGB] = (200, 40, 30)
MEANT: Final[RGB] = (190, 40, 150)
WAY: Final[RGB] = (20, 60, 150)


@functools.cache
def font(size: float, bold: bool = False) -> ImageFont.FreeTypeFont:
    """The letters that come with matplotlib."""
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name, size)


def fitted(text: str, width: float, size: float, bold: bool = False) -> ImageFont.FreeTypeFont:
    """The largest letters up to `size` in which a line is no wider than `width` pixels (but at least 8)."""
    while size > 8 and font(size, bold).getlength(text) > width:
        size -= 0.5
    return font(size, bold)


def shortened(text: str, width: float, letters: ImageFont.FreeTypeFont) -> str:
    """The text, cut off where it would be wider than `width` pixels."""
    if letters.getlength(text) <= width:
        return text
    while text and letters.getlength(text + "…") > width:
        text = text[:-1]
    return text + "…"


def mixed(color: RGB, share: float) -> RGB:
    """The colour, thinned with white to this share."""
    red, green, blue = (round(255 + share * (part - 255)) for part in color)
    return red, green, blue


def chip(draw: Draw, x: float, y: float, text: str, fill: RGB, ink: RGB) -> None:
    """A word in a rounded box whose lower edge has its middle at (x, y), with a tip that points down."""
    letters = font(12, bold=True)
    half = letters.getlength(text) / 2 + 6
    draw.polygon([(x - 5, y - 7), (x + 5, y - 7), (x, y)], fill=fill)
    draw.rounded_rectangle((x - half, y - 26, x + half, y - 6), radius=5, fill=fill)
    draw.text((x, y - 16), text, fill=ink, font=letters, anchor="mm")


def empty(size: tuple[int, int]) -> tuple[Image.Image, Draw]:
    """A new sheet, and the brush for it."""
    image = Image.new("RGB", size, PAPER)
    return image, ImageDraw.Draw(image)
