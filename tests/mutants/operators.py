"""The small errors that can be made in a statement or a condition."""

from dataclasses import dataclass

from source import CLOSERS, OPENERS, Place

OTHER_SIGNS = {
    "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "<": ["<=", ">"], "<=": ["<", ">"], ">": [">=", "<"],
    ">=": [">", "<"], "==": ["!="], "!=": ["=="], "&&": ["||"], "||": ["&&"], "+=": ["-="], "-=": ["+="],
    "*=": ["/="], "/=": ["*="],
}  # fmt: skip
OTHER_WORDS = {
    "min": "max", "max": "min", "sin": "cos", "cos": "sin", "floor": "ceil", "ceil": "floor", "true": "false",
    "false": "true", "cwiseMin": "cwiseMax", "cwiseMax": "cwiseMin", "upper": "lower", "lower": "upper",
    "any_of": "all_of", "all_of": "any_of",
}  # fmt: skip
# What is only said to people is looked at by other tests.
WORDS_FOR_PEOPLE = {"format", "refuse", "print", "println", "format_to", "describe"}


@dataclass(frozen=True)
class Change:
    """One error: `text` in place of the whole place."""

    place: Place
    text: str
    what: str
    start: int  # of what is changed in it, in the source


def _templates(source, place):
    """Numbers of the tokens inside <...> of templates. clang-format puts no spaces about these."""
    inside, depth = set(), 0
    for k, token in enumerate(place.tokens):
        tight = source.text[token.start - 1] != " " and source.text[token.end : token.end + 1] != " "
        if token.text == "<" and tight:
            depth += 1
        elif depth and token.text == ">":
            depth -= 1
        elif depth:
            inside.add(k)
    return inside


def _binary(source, token):
    return source.text[token.start - 1] in " \n" and source.text[token.end] in " \n"


def _other_numbers(text):
    plain = text.rstrip("uUlLfFzZ")
    suffix = text[len(plain) :]
    if text.startswith("0x") or not plain.replace("'", "").replace(".", "").isdigit() and "e" not in plain:
        return []
    value = float(plain.replace("'", ""))
    if value == 0:
        return ["1" + suffix.lower().replace("f", "")]
    others = ["0" + suffix.lower().replace("f", "")] if value == 1 else []
    return others + [f"(2 * {text})"]


def _arguments(tokens, open_):
    """(first, one past the last) of each argument, and where the bracket closes."""
    found, depth, first = [], 0, open_ + 1
    for k in range(open_ + 1, len(tokens)):
        text = tokens[k].text
        if depth == 0 and text in (")", ","):
            found.append((first, k))
            first = k + 1
            if text == ")":
                return found, k
        depth += text in OPENERS
        depth -= text in CLOSERS
    return [], open_


def changes_of(source, place):
    """All errors of one place."""
    found = []
    tokens = place.tokens
    templates = _templates(source, place)
    for_people = set()

    def put(start, end, text, what):
        code = " ".join(
            (source.code(place.start, start), text, source.code(end, place.end))
        ).strip()
        found.append(Change(place, code, what, start))

    for k, token in enumerate(tokens):
        if k in templates or k in for_people:
            continue
        before = tokens[k - 1] if k else None
        after = tokens[k + 1] if k + 1 < len(tokens) else None
        if token.kind == "number":
            for other in _other_numbers(token.text):
                put(token.start, token.end, other, f"{token.text} to {other}")
        elif token.kind == "word":
            other = OTHER_WORDS.get(token.text)
            if other and (token.text in ("true", "false") or after and after.text in ("(", "[") or
                          token.text in ("upper", "lower")):
                put(token.start, token.end, other, f"{token.text} to {other}")
            if after and after.text == "(":
                arguments, close = _arguments(tokens, k + 1)
                if token.text in WORDS_FOR_PEOPLE:
                    for_people.update(range(k, close))
                    continue
                for (a, b), (c, d) in zip(arguments, arguments[1:]):
                    if b <= a or d <= c:
                        continue
                    one = source.code(tokens[a].start, tokens[b - 1].end)
                    two = source.code(tokens[c].start, tokens[d - 1].end)
                    if one != two and not any(t.kind in ("string", "raw") for t in tokens[a:d]):
                        put(tokens[a].start, tokens[d - 1].end, f"{two}, {one}",
                            f"arguments of {token.text}() swapped")
        elif token.kind == "sign" and before is not None or token.text == "-":
            others = OTHER_SIGNS.get(token.text, [])
            if others and _binary(source, token) and before is not None:
                for other in others:
                    put(token.start, token.end, other, f"{token.text} to {other}")
            elif token.text == "-" and after and after.start == token.end:
                put(token.start, token.end, "", "the sign dropped")
            elif token.text == "[" and before and (before.kind == "word" or before.text in (")", "]")):
                close = next((m for m in range(k + 1, len(tokens)) if tokens[m].text == "]"), None)
                index = tokens[k + 1 : close] if close else []
                if index and all(t.kind == "word" or t.text in (".", "_") for t in index):
                    put(index[-1].end, index[-1].end, "+ 1", "the next index")
            elif token.text == "!" and after and after.start == token.end:
                put(token.start, token.end, "", "the negation dropped")
    if place.kind == "condition":
        own = source.code(place.start, place.end)
        found.append(Change(place, f"!({own})", "the condition negated", place.start))
    elif place.kind == "expression":
        found.append(Change(place, ";", "the statement dropped", place.start))
    return found
