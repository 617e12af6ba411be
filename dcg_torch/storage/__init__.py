"""Files and folders: written whole or not at all, owned by one process, and read with suspicion.

atomic_files     `write_whole`: a file that appears at once, with all its content
claim            `claim`: a folder for one process at a time
records          the lines of a run's files
untrusted_files  text, YAML and JSON that somebody else wrote, and short messages about what is wrong in it
"""
