"""The report: what a run's rows amount to, as measures, tables, figures and TensorBoard curves.

It reads `records.Iteration` and `records.Timing` and knows nothing of robots or of the model.

    intervals   95 % intervals
    causes      why a command went wrong
    measures    rows -> Measures
    seconds     timings -> where the time goes
    figures     Measures -> PNG files (canvas: what they have in common)
    board       rows and timings -> TensorBoard event file
    summary     summary.json, written whole or not at all, and read back
    tables      Measures beside the paper's figures; comparisons; sweeps
    __main__    `python -m dcg_torch.report DIR [DIR...]`
"""
