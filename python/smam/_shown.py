"""Answers as notebooks and figures show them."""

from __future__ import annotations

import html
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from ._frames import TIME

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def framed(page: Path | None, height_px: int = 900) -> str | None:
    """A page within another, scripts and downloads allowed, nothing else."""
    if page is None or not page.is_file():
        return None
    text = html.escape(page.read_text(encoding="utf-8"))
    style = f"width:100%;height:{height_px}px;border:1px solid #ccc;background:white"
    return f'<iframe srcdoc="{text}" sandbox="allow-scripts allow-downloads" style="{style}"></iframe>'


def overlay(
    measured: pd.DataFrame, simulated: dict[str, pd.DataFrame], columns: list[str], noise_sd: dict[str, float], title: str
) -> Figure:
    """Measured beside simulated, and under it what is left, with two standard deviations of the noise."""
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError("figures are drawn by matplotlib\n  remedy: pip install matplotlib") from error
    figure, axes = plt.subplots(
        2 * len(columns), sharex=True, squeeze=False, figsize=(7.5, 3.4 * len(columns)), layout="constrained", height_ratios=[2, 1] * len(columns)
    )  # fmt: skip
    colours = dict(zip(simulated, ("#c0392b", "#1f5fa8", "#2e7d32")))
    for i, column in enumerate(columns):
        above, below = axes[2 * i][0], axes[2 * i + 1][0]
        above.plot(measured.index, measured[column], color="0.2", linewidth=3, alpha=0.35, label="measured")
        for name, series in simulated.items():
            above.plot(series.index, series[column], color=colours[name], linewidth=1, label=name)
            below.plot(series.index, measured[column] - series[column], color=colours[name], linewidth=0.8)
        if column in noise_sd:
            below.axhspan(-2.0 * noise_sd[column], 2.0 * noise_sd[column], color="0.85", zorder=0)
        above.set_ylabel(column)
        below.set_ylabel("measured\n− simulated")
    axes[-1][0].set_xlabel(TIME)
    handles: list[Any] = axes[0][0].get_legend_handles_labels()[0]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), frameon=False, title=title)
    return figure
