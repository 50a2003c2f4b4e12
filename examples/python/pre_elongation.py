"""How far to elongate the muscles of an antagonistic pulley at rest: a sweep, and a figure of it.

    python examples/python/pre_elongation.py [FIGURE.png]

The cells (# %%) run one by one in Jupyter, VS Code or Spyder.
"""

# %% What is varied, and what is measured of each run (docs/sweeps.md lists all figures)
import sys

import matplotlib.pyplot as plt
import numpy as np

import smam

table = smam.sweep(
    "antagonistic_pulley",
    vary={"muscles.pre_elongation_ratio": np.linspace(0.2, 1.0, 17)},
    measure={
        "range_deg": "range(angle_deg)",
        "pressure_max_kpa": "max(pressure_1_kpa)",
        "slack_s": "slack_time(cable_1)",
        "margin_kpa": "cavitation_margin(muscle_1) / 1000",
    },
)
print(table.drop(columns="error").to_string(float_format="%.4g"))

# %% The greatest range of those whose line stays a hundred kilopascals above boiling, and whose cables never hang
safe = table[(table["margin_kpa"] > 100.0) & (table["warning_slack_s"] == 0.0)]
best = safe.loc[safe["range_deg"].idxmax()]
paper_ratio = 0.5
print(f"best: {best['muscles.pre_elongation_ratio']:.0%} with {best['range_deg']:.1f} degrees")

# %% The figure: one panel per measure, the pre-elongation in per cent below
percent = 100.0 * table["muscles.pre_elongation_ratio"]
panels = {
    "range_deg": "range of the\npulley (°)",
    "pressure_max_kpa": "greatest gauge\npressure 1 (kPa)",
    "slack_s": "time with cable 1\nslack (s)",
    "margin_kpa": "least pressure above\nboiling (kPa)",
}
figure, axes = plt.subplots(len(panels), sharex=True, figsize=(6.5, 8.0), layout="constrained")
for axis, (column, label) in zip(axes, panels.items()):
    axis.plot(percent, table[column], "o-", color="#1f5fa8", markersize=4)
    axis.axvline(100.0 * paper_ratio, color="0.6", linestyle="--", label="the paper's choice")
    axis.axvline(
        100.0 * best["muscles.pre_elongation_ratio"], color="#2a8c4a", label="greatest range, cables taut, 100 kPa above boiling"
    )
    axis.set_ylabel(label)
    axis.set_ylim(0.0, 1.1 * table[column].max())
    axis.grid(alpha=0.3)
axes[-1].set_xlabel("pre-elongation of the muscles (% of their rest length)")
figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=2, frameon=False)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "pre_elongation.png", dpi=150)
