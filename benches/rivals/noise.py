"""Noise of a channel: size and colour, whatever slow misfit lies below it; means over blocks; whitening."""

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

# Median of |x| over the standard deviation of a normal distribution.
MEDIAN_OVER_SD = 0.6744897501960817
# A stated deviation is believed unless neighbouring samples differ by this much more than it allows.
DISBELIEF = 1.1
MAX_COLOUR = 0.97


@dataclass(frozen=True)
class Noise:
    """First-order autoregressive noise of one channel."""

    sd: float
    colour: float

    def draw(self, count, random):
        """A draw of that many samples."""
        steps = random.standard_normal(count) * self.sd * np.sqrt(1.0 - self.colour**2)
        steps[0] = random.standard_normal() * self.sd
        return filter_first_order(steps, self.colour)

    def of_means(self, size):
        """Noise of the means of so many neighbours each, taken as first-order again."""
        lags = np.arange(-(size - 1), size)
        weights = size - np.abs(lags)
        powers = self.colour ** np.abs(lags)
        next_powers = self.colour ** np.abs(lags + size)
        variance = (weights * powers).sum() / size**2
        covariance = (weights * next_powers).sum() / size**2
        return Noise(self.sd * np.sqrt(variance), covariance / variance)


def filter_first_order(steps, colour):
    """x_i = colour x_(i-1) + step_i."""
    return lfilter([1.0], [1.0, -colour], steps)


def estimate_noise(residuals, stated_sd):
    """Noise from differences over one and two samples: slow misfit is gone from them.

    For x_i = rho x_(i-1) + step: var(x_(i+1) - x_i) = 2 s^2 (1 - rho), var(x_(i+2) - x_i) = 2 s^2 (1 - rho^2).
    """
    one = difference_variance(residuals, 1)
    two = difference_variance(residuals, 2)
    colour = float(np.clip(two / max(one, 1e-300) - 1.0, 0.0, MAX_COLOUR))
    found = np.sqrt(one / (2.0 * (1.0 - colour)))
    if stated_sd is None:
        return Noise(found, colour)
    if np.sqrt(one / 2.0) > DISBELIEF * stated_sd:
        return Noise(max(found, stated_sd), colour)
    by_size = float(np.clip(1.0 - one / (2.0 * stated_sd**2), 0.0, MAX_COLOUR))
    return Noise(stated_sd, max(colour, by_size))


def difference_variance(residuals, lag):
    """Variance of differences over a lag, from their median: steps do not count."""
    differences = np.concatenate([r[lag:] - r[:-lag] for r in residuals])
    finite = differences[np.isfinite(differences)]
    if len(finite) < 50:
        return np.nan
    return float((np.median(np.abs(finite)) / MEDIAN_OVER_SD) ** 2)


def block_means(values, size):
    """Means of neighbours along the first axis; a block with a missing sample is missing. The rest is cut off."""
    count = len(values) // size
    return values[: count * size].reshape(count, size, *values.shape[1:]).mean(axis=1)


def whiten(values, valid, noise):
    """Blocks of a channel in standard deviations, freed of their colour. Missing blocks are left out."""
    scale = noise.sd * np.sqrt(1.0 - noise.colour**2)
    before = np.roll(values, 1, axis=0)
    has_before = np.roll(valid, 1)
    has_before[0] = False
    with_before = (values - noise.colour * before) / scale
    alone = values / noise.sd
    shape = (-1,) + (1,) * (values.ndim - 1)
    return np.where(has_before.reshape(shape), with_before, alone)[valid]
