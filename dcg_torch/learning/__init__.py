"""What words may mean: a posterior over word -> type, from everything that was in the worlds they were said in.

    assignment  marginals of a distribution over assignments of words to types, exact and by belief propagation
    beliefs     the evidence as sufficient statistics, and the posterior that follows from it
    lexicon     the posterior as a table for people
    soft        the posterior as weighted training examples of the log-linear model

Values in, values out; numpy only.
"""
