"""English words: what each may be (noun, verb, adjective, adverb), its base form, how it is spelt.

The dictionary is made from WordNet 3.0 (`data/WORDNET-LICENSE.txt`); endings and forms beside it are data too.
"""
