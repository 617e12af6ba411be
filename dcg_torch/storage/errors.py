"""What is raised when the user, or the machine, has to mend something."""

from __future__ import annotations

import errno


class UserError(ValueError):
    """Wrong input or a machine that cannot do what was asked.

    The message is one line: what is wrong, where, and how to mend it. The command line prints it and ends with exit
    status 2; every room derives its own kind from this one.
    """


_MEND = {
    errno.ENOSPC: "make room, then give the same command again",
    errno.EDQUOT: "make room, then give the same command again",
    errno.EFBIG: "raise the limit on file sizes (ulimit -f), then give the same command again",
    errno.EROFS: "give a folder on a disk that can be written",
    errno.EACCES: "give a folder that you may write",
    errno.EPERM: "give a folder that you may write",
    errno.ENAMETOOLONG: "give a shorter name",
    errno.ENOTDIR: "a part of this path is a file; give another folder",
    errno.EEXIST: "a file is there already; give another folder",
    errno.EISDIR: "a folder is there; remove it, or give another place",
    errno.ENOENT: "give one that exists",
    errno.ELOOP: "a link leads back to itself; mend it",
    errno.EMFILE: "raise the limit on open files (ulimit -n), then give the same command again",
    errno.EIO: "the disk reports an error; take another one",
}


def explain_os_error(error: OSError) -> str:
    """One line on a file that could not be read or written: which, what the system said, how to mend it."""
    where = f"{error.filename}: " if error.filename is not None else ""
    said = error.strerror or str(error) or type(error).__name__
    mend = _MEND.get(error.errno or 0)
    return f"{where}{said}" + (f"; {mend}" if mend else "")
