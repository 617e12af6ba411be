"""Command text -> weighted readings: parse trees, each with how likely it is before the world has spoken.

    text -> tokens (one spelling, misspelt words mended)
         -> tagging (the likeliest paths through what each word may be: a weighted grammar)
         -> phrases (verbs, prepositions, noun phrases) -> repairs (what is taken back)
         -> clauses, attachment, places (what belongs to what) -> target (the tree of the object meant)
         or refusals (why it is no order about a thing)

Every word list, pattern and weight is data: `data/words.yaml` (closed classes), `patterns.yaml` (what stands for what,
prepositions, how things stand, what is refused), `grammar.yaml` (tags, transitions, choices, kinds of phrases),
`compounds.txt`, `colors.txt`, and an English dictionary made from WordNet (`english.tsv`, `irregular.tsv`). A rewriting
in `patterns.yaml` is the last resort: what a phrase or a clause says is read after tagging. A learned word makes a noun
surer, and changes how nothing else is read. Wherever a sentence can be read in several ways a run of the parser takes a
weighted choice (`decisions`); a reading is a run, and its `rules` name the choices, whose weights can be learned.

The root of a tree is a verb phrase (empty for a bare "the red cube"). Its first child holds the object meant:
a noun phrase ("find the cone") or a preposition with one ("to the cone"); `target_phrase` returns that noun phrase.
Objects named together stand together: "the red chair and the blue sofa" are both children of the root, and the two
goals of "go to the cone and the drill" both children of the preposition.

How a noun phrase is written down, beside its noun, colour and number:

    a group             "the row of five cubes" is the noun cube, plural, with the words "row" and "of 5" and no count;
                        "(the last one) in the row" has the landmark "row"
    a pick              "the bigger of the two cubes" is the noun cube with the words "bigger" and "of 2" and count 1
    a denial            "not" is part of what it denies: the word "not red", "not held"; the preposition "not on".
                        "with no cone on it" is the preposition "without", "with nothing on top of it" the word
                        "nothing on". What is ruled out is a denial of what it says more: "but not the red one" is
                        "not red", "not the one on the left" is "not on"; another thing ("not the cube") is not there
    how a thing stands  the word "facing left"; but "facing the wall" is a preposition with a landmark
    a side              the landmark "left" of the preposition "on", with the word "your" or "my" if it is someone's;
                        with no preposition ("the cube, far left") the words "far" and "left"
    a rank              ordinals are words: "first" to "tenth", "last", with what they count along behind them:
                        ("second", "from the left") also for "second leftmost"; ("second", "last") for "next to last",
                        "penultimate"; ("second", "biggest"); ("third", "from me"). A rank from a landmark has the
                        ordinal as its word and "closest to" or "farthest from" below: "second closest to the sphere"
    sets                "all", "every", "each", "both" (count 2), "any", "one of" (count 1) are words; "the two cubes"
                        has the count 2. What is left out is below the preposition "except": "everything but the cone",
                        "all cups apart from the white one"
    names               "cube 3" and "cube number 3" are the noun cube with the word "3"
    lines               "row 3" is the noun row with the word "third"; "row 3, column 2" has the column below the row
    isolation           "by itself", "isolated", "on its own" behind a noun phrase are the word "alone"
    each other          "the cubes next to each other": the landmark is another such cube, with the word "each other"
"""

from dcg_torch.language.parser import Parse, Parser, Reading, default_parser, parse_command, target_phrase

__all__ = ["Parse", "Parser", "Reading", "default_parser", "parse_command", "target_phrase"]
