"""In which order a participant meets the conditions."""

from __future__ import annotations

from typing import List, Sequence, TypeVar

from limpid.values import items_of, whole

T = TypeVar("T")


def latin_square(count: int) -> List[List[int]]:
    """Orders of so many conditions, balanced for what comes right before (Williams 1949): of an even
    number as many orders as conditions, of an odd one twice as many. In them each condition is
    as often at each place, and as often right behind each other one."""
    count = whole("count", count, 1)
    zigzag = [(i + 1) // 2 if i % 2 else (count - i // 2) % count for i in range(count)]
    rows = [[(place + shift) % count for place in zigzag] for shift in range(count)]
    return rows if count % 2 == 0 else rows + [row[::-1] for row in rows]


def order_for(participant: int, conditions: Sequence[T]) -> List[T]:
    """The order of the participant with this number, from 0 on."""
    found = items_of("conditions", conditions, "a list of at least 1 condition", 1)
    orders = latin_square(len(found))
    return [found[i] for i in orders[whole("participant", participant) % len(orders)]]
