"""Any number of throws on a torsionally elastic shaft, with the flywheel at the load end.

parameters  what a crank train consists of
articulated  rods that hang on other rods
throws      one derived throw, instantiated for every cylinder: kinematics, reactions and momentum
assembly    all of them joined by the shaft
firing      firing order, crank phases and gas forces
plan        what its parts are for, and what it answers for
"""

from mechsym.mechanisms.crank_train.assembly import build, build_rigid, listing
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters
from mechsym.mechanisms.crank_train.plan import PLAN

__all__ = ["PLAN", "CrankTrainParameters", "build", "build_rigid", "listing"]
