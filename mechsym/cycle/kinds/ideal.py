r"""Ideal air-standard cycles: what the cycle models come to when combustion is instant and nothing is lost.

p |  2'--3          Seiliger (dual): heat at constant volume 2-2', then at constant pressure 2'-3
  |  |    \         Otto: only 2-2'     Diesel: only 2-3
  |  2     \        compression 1-2 and expansion 3-4 isentropic, heat rejected at constant volume 4-1
  |   `-._  4
  |       `-1
  +----------- V
"""

from mechsym.quantities.units import Pure, Scalar


def otto_efficiency(compression_ratio: Pure[Scalar], gamma: Pure[Scalar]) -> Pure[Scalar]:
    r"""Efficiency of the Otto cycle.

    .. math:: \eta = 1 - CR^{1-\gamma}

    compression_ratio: largest over smallest volume; gamma: ratio of heat capacities.
    Source: Nunes (2017), eq. (2.3).
    """
    return 1 - compression_ratio ** (1 - gamma)
