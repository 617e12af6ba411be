"""What the words of a command come to in a scene: parse trees in the plain forms that the factors are for.

Each module takes a tree, and what is there, and gives a tree in which one thing is said in one way.
"""
