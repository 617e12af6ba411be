"""A trial as an animated GIF: the world from above, the robot's camera, the command and what it is taken to mean."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from PIL import Image, ImageDraw

from dcg_torch.experiment.recording import paint
from dcg_torch.experiment.recording.floor import FloorPanel
from dcg_torch.experiment.recording.recorder import RecordedCommand
from dcg_torch.experiment.recording.wording import bars, doing, words
from dcg_torch.simulator.camera import Camera
from dcg_torch.simulator.stage import Stage

SIZE: Final = (860, 500)
_HEAD: Final = 68  # pixels of the title
_FLOOR: Final = (532, 410)
_SIDE: Final = 548  # where the right column begins
_WIDTH: Final = 304
_CAMERA: Final = (304, 152)  # as wide and low as the robot's own
_BARS: Final = 9
_COLORS: Final = 96
_EVERY: Final = 3  # of the ten poses a second, those that become a frame
_FRAME, _GLANCE, _FIRST, _DECIDED, _LAST = 100, 180, 1800, 1600, 2600  # milliseconds that a frame stays


class Shot(NamedTuple):
    """A frame: which command of the trial, which of its moments, for how many milliseconds."""

    command: int
    moment: int
    hold: int


def animate(commands: Sequence[RecordedCommand], path: Path) -> Path:
    """Write the commands of a trial, one after the other, about three times as fast as they were.

    Args:
        commands: of one trial, from its first command on.
        path: of the GIF; its folder is made if need be. The file is there only once it is whole.

    Raises:
        ValueError: there is no command.
    """
    if not commands:
        raise ValueError("there is nothing to animate")
    camera = Camera()
    shots = [shot for number, recorded in enumerate(commands) for shot in schedule(number, recorded)]
    held = [shot for shot in shots if shot.hold > _GLANCE]
    palette = _palette(frames(commands, held[:: -(-len(held) // 12)], camera))
    flat = (image.quantize(palette=palette, dither=Image.Dither.NONE) for image in frames(commands, shots, camera))
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(".part")
    first = next(flat)
    first.save(
        part, format="GIF", save_all=True, append_images=flat, duration=[s.hold for s in shots], loop=0, optimize=True
    )
    os.replace(part, path)
    return path


def schedule(number: int, recorded: RecordedCommand) -> list[Shot]:
    """The frames of a command: all looks, some of the moments between them, longer where there is much to read."""
    shots = []
    last = len(recorded.moments) - 1
    since = 0
    for at, moment in enumerate(recorded.moments):
        since += 1
        if at == last:
            hold = _LAST
        elif at == 0:
            hold = _FIRST
        elif moment.looking:
            hold = _DECIDED if moment.looks == len(recorded.looks) else _GLANCE
        elif since >= _EVERY:
            hold = _FRAME
        else:
            continue
        since = 0
        shots.append(Shot(number, at, hold))
    return shots


def frames(commands: Sequence[RecordedCommand], shots: Iterable[Shot], camera: Camera) -> Iterator[Image.Image]:
    """The pictures of these shots, which go from command to command."""
    current, stage, sheet = -1, None, None
    try:
        for shot in shots:
            if shot.command != current or sheet is None:
                if stage is not None:
                    stage.close()
                current = shot.command
                stage = Stage(commands[current].command.world)
                sheet = _Sheet(stage, commands, current, camera)
            yield sheet.draw(shot.moment)
    finally:
        if stage is not None:
            stage.close()


class _Sheet:
    """One command's frames: title, floor, camera, chart, words."""

    def __init__(self, stage: Stage, commands: Sequence[RecordedCommand], number: int, camera: Camera) -> None:
        self._stage, self._camera = stage, camera
        self._recorded = commands[number]
        self._place = f"command {number + 1} of {len(commands)}"
        self._before: Mapping[str, str] = commands[number - 1].row.symbols if number else {}
        self._floor = FloorPanel(stage, self._recorded, camera, _FLOOR)

    def draw(self, at: int) -> Image.Image:
        image, draw = paint.empty(SIZE)
        self._title(draw, at)
        image.paste(self._floor.draw(at), (6, _HEAD))
        self._legend(draw)
        self._see(image, draw, at)
        self._chart(draw, at, _HEAD + _CAMERA[1] + 30)
        self._words(draw, at, _HEAD + _CAMERA[1] + 58 + 18 * _BARS)
        return image

    def _title(self, draw: ImageDraw.ImageDraw, at: int) -> None:
        text = f"“{self._recorded.command.text}”"
        draw.text((10, 24), text, font=paint.fitted(text, SIZE[0] - 160, 23, bold=True), fill=paint.INK, anchor="lm")
        draw.text((SIZE[0] - 10, 24), self._place, font=paint.font(13), fill=paint.GREY, anchor="rm")
        color = paint.INK
        if at == len(self._recorded.moments) - 1:
            color = paint.RIGHT if self._recorded.row.correct else paint.WRONG
        text = doing(self._recorded, at, self._before)
        draw.text((11, 51), text, font=paint.fitted(text, SIZE[0] - 20, 15), fill=color, anchor="lm")

    def _legend(self, draw: ImageDraw.ImageDraw) -> None:
        x, y = 12.0, SIZE[1] - 11
        for color, text in (
            ((190, 212, 240), "field of view"),
            (paint.WAY, "way driven"),
            (paint.MEANT, "meant by the speaker"),
            (paint.CHOICE, "the robot's choice"),
        ):
            draw.rectangle((x, y - 5, x + 12, y + 5), fill=color)
            draw.text((x + 17, y), text, font=paint.font(11.5), fill=paint.INK, anchor="lm")
            x += 17 + paint.font(11.5).getlength(text) + 16

    def _see(self, image: Image.Image, draw: ImageDraw.ImageDraw, at: int) -> None:
        """The camera's picture, with a frame round the object that the command is taken to mean."""
        moment = self._recorded.moments[at]
        self._stage.put(moment.pose)
        picture, bodies = self._camera.view(moment.pose, _CAMERA).render(self._stage.client)
        image.paste(Image.fromarray(picture), (_SIDE, _HEAD))
        solution = self._recorded.looks[moment.looks - 1].solution if moment.looks else None
        thing = solution.object if solution else None
        if thing is not None and not thing.hypothetical:
            rows, columns = np.nonzero(bodies == self._stage.bodies[thing.id])
            if len(rows):
                left, top = int(columns.min()) + _SIDE - 3, int(rows.min()) + _HEAD - 3
                right, bottom = int(columns.max()) + _SIDE + 3, int(rows.max()) + _HEAD + 3
                inside = (
                    max(left, _SIDE),
                    max(top, _HEAD),
                    min(right, _SIDE + _CAMERA[0] - 1),
                    min(bottom, _HEAD + _CAMERA[1] - 1),
                )
                draw.rectangle(inside, outline=paint.CHOICE, width=2)
        draw.text(
            (_SIDE, _HEAD + _CAMERA[1] + 10), "what the robot sees", font=paint.font(11.5), fill=paint.GREY, anchor="lm"
        )

    def _chart(self, draw: ImageDraw.ImageDraw, at: int, top: int) -> None:
        draw.text(
            (_SIDE, top), "What does the command mean?", font=paint.font(13, bold=True), fill=paint.INK, anchor="lm"
        )
        left, right = _SIDE + 196, _SIDE + _WIDTH - 40
        for k, bar in enumerate(bars(self._recorded, self._recorded.moments[at].looks, _BARS)):
            if bar.probability is None:
                continue
            y = top + 20 + 18 * k
            color = paint.KNOWN if bar.known else paint.UNKNOWN
            letters = paint.font(11, bold=bar.chosen)
            draw.text(
                (left - 6, y),
                paint.shortened(bar.name, left - 6 - _SIDE, letters),
                font=letters,
                fill=paint.INK,
                anchor="rm",
            )
            draw.rectangle((left, y - 6, right, y + 6), fill=(238, 238, 235))
            end = left + bar.probability * (right - left)
            if end >= left + 1:
                fill = paint.mixed(color, 0.45) if bar.hypothetical else color
                draw.rectangle((left, y - 6, end, y + 6), fill=fill, outline=color)
            draw.text((_SIDE + _WIDTH, y), f"{100 * bar.probability:.0f} %", font=letters, fill=paint.INK, anchor="rm")

    def _words(self, draw: ImageDraw.ImageDraw, at: int, y: int) -> None:
        over = at == len(self._recorded.moments) - 1
        known = self._recorded.row.symbols if over else self._before
        draw.text((_SIDE, y), "Words learned so far", font=paint.font(13, bold=True), fill=paint.INK, anchor="lm")
        lines = _wrapped(words(known), _WIDTH, 11.5)
        for k, line in enumerate(lines):
            draw.text((_SIDE, y + 18 + 15 * k), line, font=paint.font(11.5), fill=paint.INK, anchor="lm")
        if not lines:
            text = paint.shortened(
                f"none yet; known before: {', '.join(self._recorded.row.known_types)}", _WIDTH, paint.font(11.5)
            )
            draw.text((_SIDE, y + 18), text, font=paint.font(11.5), fill=paint.GREY, anchor="lm")


def _wrapped(parts: Sequence[str], width: float, size: float) -> list[str]:
    """The parts, joined to lines that are no wider than `width` pixels."""
    lines: list[str] = []
    for part in parts:
        longer = f"{lines[-1]},  {part}" if lines else ""
        if longer and paint.font(size).getlength(longer) <= width:
            lines[-1] = longer
        else:
            lines.append(part)
    return lines


def _palette(images: Iterable[Image.Image]) -> Image.Image:
    """One palette for all frames, so that what stands still costs nothing."""
    some = [np.asarray(image) for image in images]
    return Image.fromarray(np.concatenate(some)).quantize(_COLORS, method=Image.Quantize.MEDIANCUT)
