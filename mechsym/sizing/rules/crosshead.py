r"""The crosshead drive: pins, crosshead pin film, guide shoes, web, wear.

    piston rod --[crosshead pin, shoes on the guide]-- connecting rod --[crank pin]-- web -- main journal

The crosshead pin only swings, and in a two-stroke engine its load never turns round: what carries it is the film that
the load squeezes and the swing renews. The piston rod's buckling is in `rod`.
"""

import numpy as np

from mechsym.sizing.checks import require


def specific_pressure(F: float, length: float, width: float) -> float:
    r"""Load by projected area of a pin, a journal or a shoe.

    .. math:: p = \frac{F}{l\,b}

    Parameters
    ----------
    F : float
        Largest load [N]
    length, width : float
        Length, and diameter of a pin or width of a shoe [m]

    Returns
    -------
    p : float
        Specific pressure [Pa]

    Notes
    -----
    Source: definition; usual limits after K. Maass, H. Klier, Kraefte, Momente und deren Ausgleich in der
    Verbrennungskraftmaschine (1981), and Woodyard, Pounder's Marine Diesel Engines (2009), ch. 9. Valid: load spread
    over the whole length.

    Examples
    --------
    >>> round(specific_pressure(500e3, 0.3, 0.2) / 1e6, 2)
    8.33
    """
    require("length", length, "m", above=0)
    require("width", width, "m", above=0)
    return F / (length * width)


def squeeze_time(F: float, length: float, diameter: float, arc: float, mu: float, h_1: float, h_2: float) -> float:
    r"""Time in which a steady load squeezes the film of a pin from one thickness to another.

    .. math:: t = k\,\frac{\mu\,l\,b^3}{2 F}\left(\frac{1}{h_2^2} - \frac{1}{h_1^2}\right), \qquad
        k = 1 - \frac{192\,b}{\pi^5\,l} \sum_{n = 1, 3, ..} \frac{\tanh(n \pi l/2 b)}{n^5}, \qquad b = d\,\alpha/2

    Parameters
    ----------
    F : float
        Load [N]
    length, diameter : float
        Of the pin [m]
    arc : float
        Angle of the bearing shell that carries [rad]
    mu : float
        Viscosity of the oil [Pa*s]
    h_1, h_2 : float
        Film at the start and at the end, h_1 above h_2 [m]

    Returns
    -------
    t : float
        Time [s]

    Notes
    -----
    Source: O. Reynolds (1886), parallel plates l by b; k for the oil that leaves at the ends: Poisson's equation on a
    rectangle, D. F. Hays, J. Basic Eng. 83 (1961) 579; 1 for a long pin, 0.42 for l = b. Valid: film even over the
    arc (clearance small against h_2: a pin in a wider shell is squeezed sooner), rigid surfaces.

    Examples
    --------
    >>> round(squeeze_time(500e3, 0.3, 0.2, 2.0, 0.03, 60e-6, 10e-6), 3)
    0.411
    """
    require("load F", F, "N", above=0)
    require("film h_2", h_2, "m", above=0, below=h_1)
    width = diameter * arc / 2
    return _ends(length / width) * mu * length * width**3 / (2 * F) * (1 / h_2**2 - 1 / h_1**2)


def _ends(ratio: float) -> float:
    n = np.arange(1, 60, 2)
    return 1 - 192 / (np.pi**5 * ratio) * float(np.sum(np.tanh(n * np.pi * ratio / 2) / n**5))


def web_stress(moment: float, F: float, width: float, thickness: float) -> float:
    r"""Largest stress in a crank web of rectangular section.

    .. math:: \sigma = \frac{6 M}{w t^2} + \frac{F}{w t}

    Parameters
    ----------
    moment : float
        Bending moment about the web's weak axis [N*m]
    F : float
        Force along the web [N]
    width, thickness : float
        Section: w across, t along the shaft [m]

    Returns
    -------
    sigma : float
        Nominal stress [Pa]

    Notes
    -----
    Source: beam theory; R. S. Khurmi, J. K. Gupta, A Textbook of Machine Design (2005), ch. 32. Valid: fillets are left
    out, so the wanted factor must hold their notch effect.

    Examples
    --------
    >>> round(web_stress(40e3, 250e3, 0.4, 0.12) / 1e6, 2)
    46.88
    """
    require("width", width, "m", above=0)
    require("thickness", thickness, "m", above=0)
    return 6 * abs(moment) / (width * thickness**2) + abs(F) / (width * thickness)


def wear_index(p: np.ndarray, sliding: np.ndarray, phi: np.ndarray) -> float:
    r"""Mean over a turn of pressure times sliding speed.

    .. math:: W = \frac{1}{\Delta\varphi}\int p\,|v|\,\mathrm{d}\varphi

    Parameters
    ----------
    p : ndarray, shape (n,)
        Specific pressure over the turn [Pa]
    sliding : ndarray, shape (n,)
        Sliding speed [m/s]
    phi : ndarray, shape (n,)
        Crank angles of a whole turn, first and last point the same [rad]

    Returns
    -------
    index : float
        Mean product; wear of a given pair grows with it and the hours [Pa*m/s]

    Notes
    -----
    Source: J. F. Archard, J. Appl. Phys. 24 (1953) 981: worn depth is k p s. Valid for comparing designs of the same
    pair and lubrication.

    Examples
    --------
    >>> turn = np.linspace(0, 2 * np.pi, 721)
    >>> round(wear_index(np.full(721, 1e6), np.sin(turn), turn) / 1e6, 4)
    0.6366
    """
    return float(np.trapezoid(np.abs(p) * np.abs(sliding), phi) / (phi[-1] - phi[0]))
