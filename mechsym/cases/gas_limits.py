"""Section `[gas_limits]`: what the gas must not exceed, doubted by every command and held by `mechsym optimise`."""

from mechsym.quantities import quantity, record


@record
class GasLimits:
    """Limits of the gas that the user sets; one that is left out is none."""

    peak_pressure: float | None = quantity("Pa", default=None, above=0, below=1e9, about="absolute, in the cylinder")
    peak_temperature: float | None = quantity("K", default=None, above=0, below=1e4, about="mean over the cylinder")
    knock: float | None = quantity("-", default=None, above=0, below=1e3, about="integral that ends in knock at 1")
