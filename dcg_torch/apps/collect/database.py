"""Who wrote what, in any database that SQLAlchemy knows.

A person and an object each have a limit. Both hold among any number of processes, because every answer takes a number
below each limit, and a number is taken once: the database refuses the second.
"""

from __future__ import annotations

import contextlib
import hashlib
import secrets
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from sqlalchemy import ForeignKey, QueuePool, String, UniqueConstraint, create_engine, event, func, make_url, select
from sqlalchemy.engine import Connection, Engine
from sqlalchemy.exc import IntegrityError, SQLAlchemyError
from sqlalchemy.orm import DeclarativeBase, Mapped, Session, mapped_column

from dcg_torch.apps.collect.tasks import CollectError, Item
from dcg_torch.apps.collect.texts import copied, empty, normal, tidy

_KEPT_FOR = 600.0  # seconds that an object is kept for the person who looks at it
_AGAIN = "This could not be kept. Please send it again."
_MOST_SKIPPED = 10  # objects that a person may leave out: nobody gets a code for leaving out all
_TRIES = 20  # of an answer whose number another process took


class _Base(DeclarativeBase):
    pass


class Person(_Base):
    """One who agreed to take part; the id is a salted hash. `item` is the picture they look at, `shown` since when."""

    __tablename__ = "person"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    agreed: Mapped[str] = mapped_column(String(40))
    code: Mapped[str] = mapped_column(String(20))
    item: Mapped[str | None] = mapped_column(String(40))
    shown: Mapped[float | None]


class Written(_Base):
    """One command: the `place`-th of its person, the `number`-th for its object."""

    __tablename__ = "written"
    __table_args__ = (
        UniqueConstraint("person", "place"),
        UniqueConstraint("person", "item"),
        UniqueConstraint("item", "number"),
    )
    id: Mapped[int] = mapped_column(primary_key=True)
    person: Mapped[str] = mapped_column(ForeignKey("person.id"))
    place: Mapped[int]
    item: Mapped[str] = mapped_column(String(40))
    number: Mapped[int]
    world: Mapped[str] = mapped_column(String(100))
    object: Mapped[str] = mapped_column(String(100))
    text: Mapped[str] = mapped_column(String(1_000))
    seconds: Mapped[float | None]
    at: Mapped[str] = mapped_column(String(40))


class Skipped(_Base):
    """An object for which a person could write no command, as they could not tell which one it is."""

    __tablename__ = "skipped"
    person: Mapped[str] = mapped_column(ForeignKey("person.id"), primary_key=True)
    item: Mapped[str] = mapped_column(String(40), primary_key=True)
    at: Mapped[str] = mapped_column(String(40))


def open_database(url: str) -> Engine:
    """An engine with the tables made, if need be.

    Raises:
        CollectError: there is no such database, no driver for it, or it cannot be written.
    """
    with _one_line(url):
        engine = _engine(url)
        _Base.metadata.create_all(engine)
    return engine


def read_rows(url: str) -> list[Written]:
    """All commands of a database, in the order in which they were written.

    Raises:
        CollectError: it cannot be read, or is not one of ours.
    """
    with _one_line(url), Session(_engine(url)) as session, session.begin():
        found = list(session.scalars(select(Written).order_by(Written.id)))
        session.expunge_all()
    return found


def _engine(url: str) -> Engine:
    sqlite = make_url(url).get_backend_name() == "sqlite"
    # SQLite has one writer at a time: a queue for one connection is fair, waiting for SQLite's lock is not.
    few: dict[str, Any] = {"poolclass": QueuePool, "pool_size": 1, "max_overflow": 0} if sqlite else {}
    engine = create_engine(url, pool_pre_ping=True, **few)
    if sqlite:
        event.listen(engine, "connect", _set_up_sqlite)
        event.listen(engine, "begin", _begin_immediate)
    return engine


@contextlib.contextmanager
def _one_line(url: str) -> Iterator[None]:
    scheme, mark, rest = url.partition("://")
    where = f"database={scheme}{mark}{rest.rpartition('@')[2]}"  # without user and password
    try:
        yield
    except ModuleNotFoundError as error:
        raise CollectError(f"{where}: its driver {error.name} is not installed: pip install it") from None
    except SQLAlchemyError as error:
        said = str(getattr(error, "orig", None) or error)
        raise CollectError(f"{where}: {said}; give a database that can be opened, and is of this program") from None


def sqlite_url(path: Path) -> str:
    """The URL of a file."""
    return f"sqlite:///{path}"


def _set_up_sqlite(connection: Any, _: object) -> None:
    """Wait for other writers, and put every row on the disk before it is acknowledged."""
    connection.isolation_level = None  # transactions begin where `_begin_immediate` says
    for pragma in ("busy_timeout=5000", "journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON"):
        connection.execute(f"PRAGMA {pragma}")


def _begin_immediate(connection: Connection) -> None:
    """Take the write lock first: a reader that becomes a writer would not wait for the lock."""
    connection.exec_driver_sql("BEGIN IMMEDIATE")


@dataclass(frozen=True)
class Task:
    """What a person is to do next: an item, or none where all is done; `place` counts from 1 `of` so many.

    `skips`: may the person have another item instead?
    """

    item: Item | None
    place: int
    of: int
    skips: bool = False


@dataclass(frozen=True)
class Added:
    """Whether a command is on the disk, and else why it was refused, for the one who wrote it.

    Neither: the person has answered this item before, or others have written enough for it meanwhile.
    """

    kept: bool
    refused: str | None = None


class Answers:
    """The answers to some items. Safe to use from several threads and processes."""

    def __init__(self, engine: Engine, items: Mapping[str, Item], per_person: int, per_object: int) -> None:
        self._engine = engine
        self._items = items
        self._per_person = min(per_person, len(items))
        self._per_object = per_object

    def agree(self, person: str) -> None:
        """Note that a person takes part."""
        try:
            with Session(self._engine) as session, session.begin():
                if session.get(Person, person) is None:
                    session.add(Person(id=person, agreed=_now(), code=secrets.token_hex(5).upper()))
        except IntegrityError:  # another process has just noted it
            pass

    def code(self, person: str) -> str | None:
        """The person's own code; None if there is no such person."""
        with Session(self._engine) as session, session.begin():
            return session.scalar(select(Person.code).where(Person.id == person))

    def task(self, person: str) -> Task | None:
        """What comes next for a person, who keeps it for ten minutes; None if there is no such person."""
        with Session(self._engine) as session, session.begin():
            one = session.get(Person, person)
            if one is None:
                return None
            mine = set(session.scalars(select(Written.item).where(Written.person == person)))
            if len(mine) >= self._per_person:
                return Task(None, len(mine), self._per_person)
            skipped = set(session.scalars(select(Skipped.item).where(Skipped.person == person)))
            counts = _counts(session.execute(select(Written.item, func.count()).group_by(Written.item)))
            chosen = one.item
            used = mine | skipped
            if chosen in used or chosen not in self._items or counts.get(chosen or "", 0) >= self._per_object:
                chosen = self._choose(session, person, used, counts)
                one.item, one.shown = chosen, time.time()
            other = self._choose(session, person, {*used, chosen or ""}, counts)
            skips = other is not None and len(skipped) < _MOST_SKIPPED
            return Task(self._items[chosen] if chosen else None, len(mine) + 1, self._per_person, skips)

    def skip(self, person: str, item: str) -> None:
        """Note that a person cannot tell which object is meant; they are shown it no more, and others still are."""
        with contextlib.suppress(IntegrityError), Session(self._engine) as session, session.begin():
            gone = session.scalar(select(func.count()).where(Skipped.person == person)) or 0
            one = session.get(Person, person)
            if one is not None and one.item == item and gone < _MOST_SKIPPED:
                session.add(Skipped(person=person, item=item, at=_now()))

    def _choose(self, session: Session, person: str, used: set[str], counts: Mapping[str, int]) -> str | None:
        """An item of those with the fewest answers, written or being written; which, depends on the person."""
        recent = select(Person.item, func.count()).where(Person.shown > time.time() - _KEPT_FOR, Person.id != person)
        looked = _counts(session.execute(recent.group_by(Person.item)))
        free = [i for i in self._items if i not in used and counts.get(i, 0) < self._per_object]
        return min(free, key=lambda i: (counts.get(i, 0) + looked.get(i, 0), _shuffled(person, i)), default=None)

    def add(self, person: str, item: str, text: str) -> Added:
        """Keep a command; it is on the disk when this returns that it was kept."""
        text = tidy(text)
        if (refused := empty(text)) is not None:
            return Added(False, refused)
        for _ in range(_TRIES if item in self._items else 0):
            try:
                with Session(self._engine) as session, session.begin():
                    return self._insert(session, person, self._items[item], text)
            except IntegrityError:  # another process took the number
                continue
        return Added(False, _AGAIN)

    def _insert(self, session: Session, person: str, item: Item, text: str) -> Added:
        told = select(Written.item, Written.text).where(Written.person == person)
        mine: dict[str, str] = dict(iter(session.execute(told)))
        if item.id in mine or len(mine) >= self._per_person:
            return Added(mine.get(item.id) == text)
        if refused := copied(text, {normal(earlier) for earlier in mine.values()}):
            return Added(False, refused)
        taken = session.scalar(select(func.count()).where(Written.item == item.id)) or 0
        one = session.get(Person, person)
        if one is None or taken >= self._per_object:
            return Added(False)
        seconds = time.time() - one.shown if one.shown is not None and one.item == item.id else None
        if seconds is not None and seconds < 0.0:  # the clock was put back
            seconds = None
        at = {"place": len(mine) + 1, "number": taken + 1, "seconds": seconds, "at": _now()}
        session.add(Written(person=person, item=item.id, world=item.world, object=item.object, text=text, **at))
        return Added(True)


def _counts(result: Iterable[Any]) -> dict[str, int]:
    return {item: number for item, number in result if item is not None}


def _shuffled(person: str, item: str) -> bytes:
    return hashlib.blake2b(f"{person} {item}".encode()).digest()


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
