"""People write commands for highlighted objects, as the paper's workers on Mechanical Turk did (Section IV-A).

`serve` asks them on pages of its own, `hit` makes what Mechanical Turk needs, `importing` makes world files and
episodes of what they wrote.
"""
