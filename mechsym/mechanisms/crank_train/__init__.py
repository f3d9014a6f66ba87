"""Any number of throws on a torsionally elastic shaft, with the flywheel at the load end.

parameters  what a crank train consists of
parts       one derived throw, instantiated for every cylinder and joined by the shaft
forces      kinematics, reactions and momentum per throw
firing      firing order, crank phases and gas forces
chain       what it says of itself to other rooms
"""

from mechsym.mechanisms.crank_train.assembly import build, build_driven, build_rigid, listing
from mechsym.mechanisms.crank_train.chain import TRAITS
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters

__all__ = ["TRAITS", "CrankTrainParameters", "build", "build_driven", "build_rigid", "listing"]
