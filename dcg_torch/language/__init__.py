"""Command text -> ParseTree. spaCy's parse is the base; this room mends what it gets wrong in commands.

    text -> reader (spelling, spaCy) -> chunks (verbs, prepositions, noun phrases; repairs of tags)
         -> clauses, attachment, places (what belongs to what) -> target (the tree of the object meant)

The root of a tree is a verb phrase (empty for a bare "the red cube"). Its first child holds the object meant:
a noun phrase ("find the cone") or a preposition with one ("to the cone"); `target_phrase` returns that noun phrase.
"""

from dcg_torch.language.parser import Parse, Parser, default_parser, parse_command, target_phrase

__all__ = ["Parse", "Parser", "default_parser", "parse_command", "target_phrase"]
