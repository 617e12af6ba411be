"""The report: what runs' rows amount to, as measures, tables, figures, TensorBoard curves and CSV.

It reads `records.Iteration` and `records.Timing` and knows nothing of robots or of the model. Each module imports only
modules above it:

    text, intervals     numbers as text; 95 % intervals
    calibration         does a probability mean what it says
    causes, steps       why a command went wrong; rows with what follows from the row before
    measures, seconds   rows -> Measures; timings -> where the time goes
    paper               the paper's figures, and which runs may stand beside them
    summary, runs       summary.json; run folders, read back
    configurations      runs that differ in their seed alone, together; paired differences
    export              a row a run as CSV
    tables, comparison_tables           of one run; of several
    canvas, figures, comparison         figures of one run; of several
    board               TensorBoard event file
    show                what a run and what a sweep print and draw
    __main__, trade_off                 the command lines
"""
