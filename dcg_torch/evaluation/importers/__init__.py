"""Scenes and commands of others, as episode files.

base            what came of it: lines, and what was left out and why
h2sl            examples of the Human-to-Structured-Language library (XML)
h2sl_symbols    its symbol dictionaries (XML), as training files
iref_vla        scene graphs with referential statements (JSON)
concept_graphs  objects and relations of ConceptGraphs (JSON); commands are generated
table           a CSV file with a row per object
"""
