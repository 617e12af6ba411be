"""What a person says that is no order about a thing: a teacher's sentences, questions, motions, answers.

The words and patterns of each are data, in `data/`. Commands are read by `language`.
"""
