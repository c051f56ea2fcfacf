"""Means, ratios and their standard errors over scenes."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from singulation_core.polygon import FloatArray

_DRAWS = 2000  # of the bootstrap


@dataclass(frozen=True, slots=True)
class Estimate:
    """A number with its standard error."""

    value: float
    error: float

    def percent(self) -> str:
        """As a percentage: ``73.2 ± 0.9``; a dash if there is nothing to say."""
        if not np.isfinite(self.value):
            return "-"
        return f"{100 * self.value:.1f} ± {100 * self.error:.1f}"


def gains(results: pd.DataFrame) -> pd.DataFrame:
    """s' - s of each scene (rows: n, group, scenario) under each (policy, contact_mode, fits) (columns)."""
    table = results.assign(gain=results["after"] - results["before"])
    return table.pivot(index=["n", "group", "scenario"], columns=["policy", "contact_mode", "fits"], values="gain")


def share(numerator: FloatArray, denominator: FloatArray) -> Estimate:
    """Ratio of the means of two quantities over the same scenes; error by bootstrap over scenes.

    Args:
        numerator, denominator: (scenes,); scenes in which either is NaN are left out.
    """
    both = np.isfinite(numerator) & np.isfinite(denominator)
    if not both.any():
        return Estimate(np.nan, np.nan)
    top, bottom = numerator[both], denominator[both]
    weights = np.random.default_rng(0).multinomial(len(top), np.full(len(top), 1.0 / len(top)), _DRAWS)
    with np.errstate(divide="ignore", invalid="ignore"):
        draws = (weights @ top) / (weights @ bottom)
    value = top.mean() / bottom.mean() if bottom.mean() != 0.0 else np.nan
    return Estimate(float(value), float(np.nanstd(draws)) if np.isfinite(draws).any() else np.nan)


def mean(values: FloatArray) -> Estimate:
    """Mean of (scenes,) values and its standard error; NaN are left out."""
    known = values[np.isfinite(values)]
    if len(known) == 0:
        return Estimate(np.nan, np.nan)
    error = known.std(ddof=1) / np.sqrt(len(known)) if len(known) > 1 else np.nan
    return Estimate(float(known.mean()), float(error))


def difference(first: FloatArray, second: FloatArray, reference: FloatArray) -> Estimate:
    """Paired difference of two policies' shares of a reference; error by bootstrap over scenes."""
    return share(first - second, np.where(np.isfinite(first - second), reference, np.nan))
