"""Source 004, Nunes (2017), chapters 3 and 5: what the text claims of the engine model and its results."""

from mechsym.audit.entries import Entry, TextClaim
from mechsym.papers.nunes2017 import claims_engine as claims
from mechsym.papers.nunes2017 import claims_parts as parts

MODEL: tuple[Entry, ...] = (
    TextClaim(equation="list of symbols", claim="gamma is in J/(kg K)", decide=claims.heat_capacity_ratio),
    TextClaim(equation="text 3.1.1", claim="the displacement is 2.9405e-5 m^3", decide=claims.displacement),
    TextClaim(equation="table 3.1", claim="the second column is the duration, the third the start of combustion",
              decide=claims.combustion_columns),
    TextClaim(equation="table 3.2", claim="the piston's area is 0.02827 m^2", decide=parts.piston_area),
    TextClaim(equation="text 3.4.3", claim="the largest pressure is 9.604 MPa", decide=claims.vapour_charge),
    TextClaim(equation="2.64", claim="p A_piston with the absolute p is the net pressure force",
              decide=claims.net_pressure),
    TextClaim(equation="text 3.4", claim="the engines' largest torques are 276.255 and 243.6 N m",
              decide=claims.peak_torque),
)  # fmt: skip

RESULTS: tuple[Entry, ...] = (
    TextClaim(equation="text 5.1.1", claim="the fuel left unburnt is 0.141 to 0.144", decide=claims.unburnt),
    TextClaim(equation="text 5.1", claim="the average torques are largest at 5400 and at 6700 rpm",
              decide=claims.best_speeds),
    TextClaim(equation="text 5.2", claim="the average torques cross at 6436 rpm", decide=claims.crossover),
)  # fmt: skip
