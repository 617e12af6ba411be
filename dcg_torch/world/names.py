"""Names of types and colours for worlds beyond the paper's: things of a house and street, basic colours."""

from __future__ import annotations

from typing import Final

from dcg_torch.world.generator import COLORS, TYPES

MORE_TYPES: Final = (
    *TYPES,
    *("bottle", "bucket", "kettle", "lamp", "chair", "ladder", "barrel", "basket", "wrench", "hammer", "shovel"),
    *("broom", "backpack", "helmet", "suitcase", "umbrella", "guitar", "bicycle", "toaster", "teapot", "vase"),
    *("pillow", "clock", "radio", "candle", "statue", "bench", "fan", "trolley", "tripod", "crate", "plant"),
)
MORE_COLORS: Final = (*COLORS, "yellow", "orange", "purple", "pink", "brown", "white", "black")
