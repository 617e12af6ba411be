"""What words say about things: the names that a recogniser gives, words for colours, attributes, places and groups.

    normal_form       one normal form for each name
    wordnet           the table: synonyms, and what is a kind of what
    evidence          facts that hold between a noun and a class name
    weights           how much each fact tells
    noun_similarity   how near two nouns are, whatever class they are held against
    attribute_values  words for the values of attributes, and which of them exclude one another
    keys              keys with values as attributes; what a key and a noun name
    attributes        facts between words and the attributes of an object
    colors            colour words as regions of CIELAB; facts between a colour word and the name of a colour
    embedding         cosines of a sentence embedding (the extra `embeddings`)
    vocabulary        words with a fixed meaning: places, groups, who owns a side

Everything but the reading of the data is a pure function. Nothing is normalised in what a caller keeps: names are
written out as they came.
"""

from dcg_torch.names.evidence import evidence
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.weights import fact_weights, log_odds

__all__ = ["evidence", "fact_weights", "log_odds", "normalise"]
