"""What a plan of balancing is made of: parts of a machine, whose file holds it."""

from equipoise.mechanism.balance import AddedMass as AddedMass
from equipoise.mechanism.balance import Balance as Balance
from equipoise.mechanism.balance import BalanceShafts as BalanceShafts
from equipoise.mechanism.balance import CenterMove as CenterMove
from equipoise.mechanism.balance import GearedWeight as GearedWeight
from equipoise.mechanism.balance import Limit as Limit
from equipoise.mechanism.balance import Objective as Objective
from equipoise.mechanism.balance import Phases as Phases
from equipoise.mechanism.balance import SpringChoice as SpringChoice
from equipoise.mechanism.balance import Weight as Weight
