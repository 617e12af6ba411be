"""The factor graph of a command in a world, and the search for phi*.

Eqs. 2, 5 and 7: phi* maximises the product over phrases i and groundings j of Psi(phi_ij | gamma_ij,
lambda_i, Gamma_c_ij, Upsilon). A command means one thing, so phi* is sought among the configurations in which
each phrase corresponds (ACTIVE or INVERTED) to exactly one grounding and is INACTIVE for the others; the
chosen grounding of a child is Gamma_c of its parent. The score of such a configuration is

    sum_i [ sum_j log Psi(phi_ij = 0)  +  log Psi(phi_ij*) - log Psi(phi_ij* = 0) ]

and is found leaf to root: every phrase keeps a beam of its best hypotheses for its parent. With a beam as
wide as there are hypotheses the search is exact. One pass gives the best configuration, the probabilities of
all objects, the runner-up, and the factors of the modifiers.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from dcg_torch.fitting.psi import LogLinearFactor
from dcg_torch.grounding.encoders import Encoders
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features import FeatureSet
from dcg_torch.grounding.search import Search
from dcg_torch.grounding.solution import Solution
from dcg_torch.grounding.tables import Tables
from dcg_torch.types import ParseTree, WorldModel

if TYPE_CHECKING:
    import networkx as nx


def solver(encoders: Encoders, factor: LogLinearFactor, *, beam: int) -> Callable[[ParseTree, WorldModel], Solution]:
    """Grounds trees in many worlds under the weights as they are now, which it looks up once for each phrase.

    Its solutions have no runner-up.
    """
    tables = Tables(encoders.features, factor)

    def solve(tree: ParseTree, world: WorldModel) -> Solution:
        return Search(encoders.of(world), tables, beam).solve(tree, brief=True)

    return solve


class FactorGraph:
    """The correspondence variables and factors of one command in one world.

    Args:
        tree: the command's parse tree; its root is grounded last.
        world: Upsilon.
        encoder: of the world; to be given where it has been used before.
    """

    def __init__(self, tree: ParseTree, world: WorldModel, encoder: WorldEncoder | None = None) -> None:
        self.tree = tree
        self.world = world
        self._encoder = encoder

    @cached_property
    def phrases(self) -> nx.DiGraph:
        """The parse tree as a graph: node k has its subtree in "tree", edges lead from child to parent."""
        import networkx as nx  # here: the search needs none

        graph = nx.DiGraph()

        def add(tree: ParseTree) -> int:
            node = int(graph.number_of_nodes())
            graph.add_node(node, tree=tree)
            for child in tree.children:
                graph.add_edge(add(child), node)
            return node

        add(self.tree)
        return graph

    def solve(
        self, features: FeatureSet, factor: LogLinearFactor, *, beam: int = 8, tables: Tables | None = None
    ) -> Solution:
        """Leaf-to-root inference (Alg. 1, line 11).

        Args:
            beam: hypotheses of a phrase that its parent considers.
            tables: of the phrases under these columns and weights; to be given where there are some.
        """
        encoder = self._encoder or WorldEncoder(features, self.world)
        return Search(encoder, tables or Tables(features, factor), beam).solve(self.tree)
