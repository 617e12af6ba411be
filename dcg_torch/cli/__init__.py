"""The command line: Hydra's side of the settings, errors as one line and an exit status, sweeps, and the terminal.

config         schemas, settings from what Hydra composed, Hydra's errors explained
settings_help  what each setting means, for --help
application    errors -> one line and an exit status
sweep          the folder and the table of a sweep
console        width, colours, progress bars
run            one experiment, or a sweep of them
evaluate       the commands of episode files
convert        files of others
commands       `dcg-torch COMMAND`: which there are, each loaded when it is called
completion     what a shell completes
"""
