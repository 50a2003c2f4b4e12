"""Noise of a channel, white and a part that forgets exponentially, read beside slow misfit; block means; whitening."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.signal import lfilter

# Time over which the running mean is taken that separates misfit from noise, s, and its bounds in samples.
WINDOW_S = 0.5
WINDOW = (21, 51)
# Times over which noise may remember itself, samples; the longest, s, and its bounds in samples.
MEMORIES = (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
MEMORY_S = 0.1
MEMORY = (2.0, 10.0)
# Samples of a piece over which a covariance is taken, the number of lags that is read, and a length for its transform.
PIECE = 200
LAGS = 26
TRANSFORM = 240
# A slow part counts from so many standard errors on that white noise alone may seem to have of it.
LEAST_SLOW = 4.0
# A stated deviation is believed unless what is found is this much more.
DISBELIEF = 1.1


@dataclass(frozen=True)
class Noise:
    """Covariance sd^2 ((1 - s) [lag = 0] + s kept^lag), with s the share that is slow."""

    sd: float
    slow_share: float = 0.0
    kept: float = 0.0

    @property
    def inflation(self):
        """By how much it is stronger against slow signals than white noise of that deviation."""
        return 1.0 + 2.0 * self.slow_share * self.kept / (1.0 - self.kept)

    def draw(self, count, random):
        """A draw of that many samples."""
        white = random.standard_normal(count) * np.sqrt(1.0 - self.slow_share)
        if self.slow_share == 0.0:
            return self.sd * white
        steps = random.standard_normal(count)
        steps[1:] *= np.sqrt(1.0 - self.kept**2)
        return self.sd * (white + np.sqrt(self.slow_share) * lfilter([1.0], [1.0, -self.kept], steps))

    def of_means(self, size):
        """Noise of the means of so many neighbours each."""
        lags = np.arange(-(size - 1), size)
        weights = (size - np.abs(lags)) / size**2
        slow = self.sd**2 * self.slow_share
        variance = self.sd**2 * (1.0 - self.slow_share) / size + slow * (weights * self.kept ** np.abs(lags)).sum()
        return NoiseOfMeans(variance, slow * (weights * self.kept ** (lags + size)).sum(), self.kept**size)


@dataclass(frozen=True)
class NoiseOfMeans:
    """Of block means: variance, covariance of neighbours, and what of that is kept from each block to the next."""

    variance: float
    neighbours: float
    kept: float

    @property
    def slow_sd(self):
        """Deviation of white noise as strong as this one is at low frequencies."""
        return np.sqrt(self.variance + 2.0 * self.neighbours / (1.0 - self.kept))

    def innovations(self):
        """Share of the last surprise in the next value, beside what is kept of that, and the deviation of surprises.

        x_i - kept x_(i-1) is a moving average of first order: its root within the unit circle.
        """
        power = self.variance * (1.0 + self.kept**2) - 2.0 * self.kept * self.neighbours
        product = self.neighbours - self.kept * self.variance
        root = np.sqrt(max(power**2 - 4.0 * product**2, 0.0))
        share = 2.0 * product / (power + root)
        return share, np.sqrt(0.5 * (power + root))


def estimate_noise(residuals, stated_sd, interval_s):
    """White and slow part whose covariance, once a running mean is taken off, is nearest to that of the residuals.

    Size as stated, unless more is found: what is slower than half a second may be misfit and is not asked.
    """
    half = int(np.clip(round(WINDOW_S / interval_s), *WINDOW)) // 2
    fast = [fast_part(r, half) for r in residuals]
    white, slow, kept = two_parts(usual_covariance(fast), half, float(np.clip(MEMORY_S / interval_s, *MEMORY)))
    variance = white + slow
    if stated_sd is not None and variance <= (DISBELIEF * stated_sd) ** 2:
        variance = stated_sd**2
        slow = min(slow, max(variance - white, 0.0))
    count = sum(np.isfinite(f).sum() for f in fast)
    if slow <= LEAST_SLOW * variance / np.sqrt(max(count, 1)):
        return Noise(float(np.sqrt(variance)))
    return Noise(float(np.sqrt(variance)), float(slow / variance), kept)


def fast_part(values, half):
    """What a running mean leaves; missing where any sample of it is."""
    window = 2 * half + 1
    if len(values) < window:
        return np.full(1, np.nan)
    missing = ~np.isfinite(values)
    sums = running_sums(np.where(missing, 0.0, values), window)
    left = values[half : len(values) - half] - sums / window
    left[running_sums(missing, window) > 0] = np.nan
    return left


def running_sums(values, window):
    """Sums over all windows of so many neighbours."""
    sums = np.cumsum(np.append(0, values))
    return sums[window:] - sums[:-window]


def usual_covariance(runs):
    """Covariance by lag: median over pieces, so that misfit that comes in bursts does not count."""
    pieces = np.concatenate([np.append(r, np.full(-len(r) % PIECE, np.nan)).reshape(-1, PIECE) for r in runs])
    finite = np.isfinite(pieces)
    whole = finite.sum(axis=1) > PIECE / 2
    if not whole.any():
        return products(np.nan_to_num(pieces)).sum(axis=0) / np.maximum(products(finite).sum(axis=0), 1.0)
    return np.median(products(np.nan_to_num(pieces[whole])) / np.maximum(products(finite[whole]), 1.0), axis=0)


def products(pieces):
    """Sums of x_i x_(i+lag) within each piece, by lag."""
    spectrum = np.fft.rfft(pieces, TRANSFORM, axis=1)
    return np.fft.irfft(np.abs(spectrum) ** 2, TRANSFORM, axis=1)[:, :LAGS]


def two_parts(found, half, longest):
    """Variance of the white part, of the slow one and what that keeps: least squares of both over all memories."""
    kept, white, slow = filtered(half, longest)
    (aa, ab, bb), (ay, by) = (white @ white, slow @ white, (slow**2).sum(axis=1)), (white @ found, slow @ found)
    a, b = (ay * bb - by * ab) / (aa * bb - ab**2), (by * aa - ay * ab) / (aa * bb - ab**2)
    only_slow, only_white = (a <= 0.0) & (b > 0.0), b <= 0.0
    a = np.where(only_slow, 0.0, np.where(only_white, max(ay / aa, 0.0), a))
    b = np.where(only_slow, np.maximum(by / bb, 0.0), np.where(only_white, 0.0, b))
    best = ((found - a[:, None] * white - b[:, None] * slow) ** 2).sum(axis=1).argmin()
    return a[best], b[best], float(kept[best])


@lru_cache(maxsize=64)
def filtered(half, longest):
    """What each memory keeps; what is left, by lag, of the covariance of white noise and of each once a running mean is
    taken off."""
    taken = np.full(2 * half + 1, -1.0 / (2 * half + 1))
    taken[half] += 1.0
    power = np.convolve(taken, taken[::-1])
    lags = np.abs(np.arange(-2 * half, LAGS + 2 * half))
    kept = np.exp([-1.0 / m for m in MEMORIES if m <= longest])
    slow = [np.convolve(k**lags, power, mode="valid") for k in kept]
    return kept, np.convolve(lags == 0, power, mode="valid"), np.array(slow)


def block_means(values, size):
    """Means of neighbours along the first axis; a block with a missing sample is missing. The rest is cut off."""
    count = len(values) // size
    return values[: count * size].reshape(count, size, *values.shape[1:]).mean(axis=1)


def whiten(values, valid, noise):
    """Blocks of a channel in standard deviations, freed of their colour. Missing blocks are left out."""
    share, deviation = noise.innovations()
    edges = np.flatnonzero(np.diff(valid.astype(int), prepend=0, append=0))
    parts = [values[:0]]
    for begin, end in edges.reshape(-1, 2):
        surprises = lfilter([1.0, -noise.kept], [1.0, share], values[begin:end], axis=0) / deviation
        surprises[0] = values[begin] / np.sqrt(noise.variance)
        parts.append(surprises)
    return np.concatenate(parts)
