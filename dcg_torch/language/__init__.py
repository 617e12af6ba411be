"""Command text -> ParseTree. spaCy's parse is the base; this room mends what it gets wrong in commands.

    text -> reader (spelling, spaCy) -> chunks (verbs, prepositions, noun phrases; repairs of tags)
         -> clauses, attachment, places (what belongs to what) -> target (the tree of the object meant)

The root of a tree is a verb phrase (empty for a bare "the red cube"). Its first child holds the object meant:
a noun phrase ("find the cone") or a preposition with one ("to the cone"); `target_phrase` returns that noun phrase.
Objects named together stand together: "the red chair and the blue sofa" are both children of the root, and the two
goals of "go to the cone and the drill" both children of the preposition.

How a noun phrase is written down, beside its noun, colour and number:

    a group             "the row of five cubes" is the noun cube, plural, with the words "row" and "of 5" and no count;
                        "(the last one) in the row" has the landmark "row"
    a pick              "the bigger of the two cubes" is the noun cube with the word "bigger" and count 1
    a denial            "not" is part of what it denies: the word "not red", "not held"; the preposition "not on".
                        "with no cone on it" is the preposition "without", "with nothing on top of it" the word
                        "nothing on". What is ruled out ("the cone, not the cube") is not in the tree
    how a thing stands  the word "facing left"; but "facing the wall" is a preposition with a landmark
    a side              the landmark "left" of the preposition "on", with the word "your" or "my" if it is someone's;
                        with no preposition ("the cube, far left") the words "far" and "left"
    each other          "the cubes next to each other": the landmark is another such cube, with the word "each other"
"""

from dcg_torch.language.parser import Parse, Parser, default_parser, parse_command, target_phrase

__all__ = ["Parse", "Parser", "default_parser", "parse_command", "target_phrase"]
