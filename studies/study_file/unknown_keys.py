"""What an error says of a key that no table has, or that has the wrong suffix."""

from studies.study_file.keys import Key, Table, closest, hint


def known_keys(spelling: str, table: Table) -> tuple[str, list[str]]:
    """Words that tell which keys there are; and the key that the unknown one most likely means, if there is one."""
    near = closest([spelling], _all_spellings(table))
    words = f"one of {', '.join(sorted(table.keys))}{hint(near)}"
    meant = near if near is None or near in table.keys else near.rsplit("_", 1)[0]
    return words, [meant] if meant else []


def spellings(name: str, key: Key) -> str:
    """The words for a key with a suffix that it does not take."""
    return f"{name} ({key.unit}) or {name}_{key.suffix}" if key.suffix else f"{name} without a suffix"


def _all_spellings(table: Table) -> list[str]:
    suffixed = [f"{name}_{key.suffix}" for name, key in table.keys.items() if isinstance(key, Key) and key.suffix]
    return [*table.keys, *suffixed]
