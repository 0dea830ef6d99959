"""Where in a C++ source an error can be planted, and how several of them live in one program.

The source is read lightly: tokens, function bodies, statements. Each place is a whole statement or
condition. It is written once as it is and once for each planted error; a number from outside chooses
at run time which of them is carried out. So one build holds many errors, and each statement of the
program stays where it was: the lines keep their numbers.
"""

import bisect
import re
from dataclasses import dataclass

TOKEN = re.compile(
    r"""(?P<space>\s+)
      |(?P<comment>//[^\n]*|/\*.*?\*/)
      |(?P<raw>(?:u8|[uUL])?R"(?P<delimiter>[^()\\\s]*)\(.*?\)(?P=delimiter)")
      |(?P<string>(?:u8|[uUL])?"(?:\\.|[^"\\\n])*"(?:_\w+)?)
      |(?P<char>'(?:\\.|[^'\\\n])+')
      |(?P<number>(?:\d|\.\d)(?:[eEpP][+-]|'?[\w.])*)
      |(?P<word>[A-Za-z_]\w*)
      |(?P<sign><=>|<<=|>>=|->\*|\.\.\.|::|->|\+\+|--|&&|\|\||<=|>=|==|!=|\+=|-=|\*=|/=|%=|\|=|&=|\^=|<<|.)""",
    re.X | re.S,
)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", re.M)
OPENERS, CLOSERS = "([{", ")]}"


@dataclass(frozen=True)
class Token:
    kind: str
    text: str
    start: int

    @property
    def end(self):
        return self.start + len(self.text)


@dataclass(frozen=True)
class Place:
    """A statement or condition. kind: expression, return, condition, or value (the right side of a
    declaration, of the type `type`)."""

    kind: str
    start: int  # in the text; a statement's last character is its semicolon
    end: int
    tokens: tuple
    type: str = ""


class Source:
    def __init__(self, text):
        self.text = text
        blank = DIRECTIVE.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
        self.tokens = [
            Token(m.lastgroup if m.lastgroup != "delimiter" else "raw", m.group(), m.start())
            for m in TOKEN.finditer(blank)
            if m.lastgroup not in ("space", "comment")
        ]
        self.match = self._brackets()
        self.places = []
        self._lines = [m.end() for m in re.finditer(r"\n", text)]
        self._scope(0, len(self.tokens))

    def line(self, offset):
        return bisect.bisect_right(self._lines, offset) + 1

    def code(self, start, end):
        """In one line, without comments."""
        text = self.text[start:end]
        pieces = (" " if m.lastgroup in ("space", "comment") else m.group() for m in TOKEN.finditer(text))
        return re.sub(r" +", " ", "".join(pieces)).strip()

    def _brackets(self):
        match, open_ = {}, []
        for i, token in enumerate(self.tokens):
            if token.text in OPENERS and token.kind == "sign":
                open_.append(i)
            elif token.text in CLOSERS and token.kind == "sign":
                if not open_ or OPENERS.index(self.tokens[open_[-1]].text) != CLOSERS.index(token.text):
                    raise ValueError(f"line {self.line_of(token)}: brackets do not match")
                match[open_.pop()] = i
        if open_:
            raise ValueError(f"line {self.line_of(self.tokens[open_[-1]])}: brackets do not match")
        return match

    def line_of(self, token):
        return self.text.count("\n", 0, token.start) + 1

    # Namespaces and classes: looks for the bodies of functions.
    def _scope(self, i, end):
        head = i
        while i < end:
            text = self.tokens[i].text
            if text == "(" or text == "[":
                i = self.match[i] + 1
            elif text == ";":
                head = i = i + 1
            elif text == "=" and self.tokens[i - 1].text != "operator":
                i = self._end_of_statement(i, end) + 1
                head = i
            elif text == "{":
                close = self.match[i]
                before = [t.text for t in self.tokens[head:i]]
                kind = self._kind_of_braces(before)
                if kind == "scope":
                    self._scope(i + 1, close)
                elif kind == "body" and not {"constexpr", "consteval"} & set(before):
                    self._block(i + 1, close)
                i = close + 1
                if kind != "value":
                    head = i
            else:
                i += 1

    @staticmethod
    def _kind_of_braces(before):
        if "enum" in before:
            return "other"
        outside, depth = [], 0
        for text in before:
            depth -= text in CLOSERS
            if depth == 0:
                outside.append(text)
            depth += text in OPENERS
        if "namespace" in outside or outside[:1] == ["extern"]:
            return "scope"
        if ")" not in outside:
            return "scope" if {"class", "struct", "union"} & set(outside) else "value"
        if outside[-1] in (")", "}", "const", "noexcept", "override", "final", "try", "&", "&&"):
            return "body"
        after = outside[len(outside) - outside[::-1].index(")") :]
        return "body" if "->" in after else "value"

    def _end_of_statement(self, i, end):
        while i < end and self.tokens[i].text != ";":
            i = self.match.get(i, i) + 1
        return i

    # The inside of a function.
    def _block(self, i, end):
        while i < end:
            text = self.tokens[i].text
            if text in ("else", "do", "try", ";"):
                i += 1
            elif text == "{":
                self._block(i + 1, self.match[i])
                i = self.match[i] + 1
            elif text in ("if", "while", "for", "switch", "catch"):
                fixed = self.tokens[i + 1].text == "constexpr"
                open_ = i + 1 + fixed
                close = self.match.get(open_)
                if close is None:
                    return
                if not fixed:
                    self._condition(text, open_ + 1, close)
                i = close + 1
            elif text == "case" or text == "default":
                while self.tokens[i].text != ":":
                    i += 1
                i += 1
            else:
                stop = self._end_of_statement(i, end)
                self._statement(i, stop)
                i = stop + 1

    def _condition(self, word, i, end):
        parts, at = [i], i
        while at < end:
            if self.tokens[at].text == ";":
                parts.append(at + 1)
            at = self.match.get(at, at) + 1
        if word in ("switch", "catch") or (word == "for" and len(parts) != 3):
            return
        start = parts[1] if word == "for" else parts[-1]
        stop = parts[2] - 1 if word == "for" else end
        tokens = self.tokens[start:stop]
        if tokens and not self._lambdas(start, stop) and not any(t.text == "=" for t in tokens):
            self.places.append(
                Place("condition", tokens[0].start, tokens[-1].end, tuple(tokens))
            )

    # The braces of lambdas; other braces hold values.
    def _lambdas(self, i, end):
        found = []
        while i < end:
            if self.tokens[i].text == "{":
                before = self.tokens[i - 1].text
                if before in (")", "]", "mutable", "noexcept") or self._trailing_type(i):
                    found.append(i)
                    i = self.match[i]
            i += 1
        return found

    def _trailing_type(self, i):
        while self.tokens[i - 1].kind == "word" or self.tokens[i - 1].text in ("::", "<", ">", "*", "&", ","):
            i -= 1
        return self.tokens[i - 1].text == "->" and self.tokens[i - 2].text in (")", "mutable", "noexcept")

    def _statement(self, i, stop):
        tokens = tuple(self.tokens[i:stop])
        if not tokens:
            return
        if tokens[0].text in ("struct", "class", "union", "enum"):
            return
        lambdas = self._lambdas(i, stop)
        for each in lambdas:
            self._block(each + 1, self.match[each])
        fixed = ("throw", "using", "static_assert", "static", "constexpr", "break", "continue", "goto",
                 "delete", "typedef", "thread_local", "asm")
        if lambdas or tokens[0].text in fixed or [t.text for t in tokens[:2]] == ["[", "["]:
            return
        start, end = tokens[0].start, tokens[-1].end + 1
        if self.text[end - 1] != ";":
            end = self.tokens[stop].end if stop < len(self.tokens) else tokens[-1].end
        if tokens[0].text == "return":
            if len(tokens) > 1 and tokens[1].text != "{":
                self.places.append(Place("return", start, end, tokens[1:]))
            return
        equals = self._top_level("=", i, stop)
        head = self.tokens[i : equals if equals else stop]
        declared = self._declares(head)
        if not declared:
            self.places.append(Place("expression", start, end, tokens))
        elif equals and not self._top_level(",", equals, stop) and "[" not in [t.text for t in head]:
            value = tuple(self.tokens[equals + 1 : stop])
            if value and value[0].text != "{":
                words = [t.text for t in head[:-1] if t.text != "const"]
                type_ = "" if {"auto", "&", "*"} & set(words) else " ".join(words)
                self.places.append(Place("value", value[0].start, value[-1].end, value, type_))

    def _top_level(self, text, i, stop):
        while i < stop:
            if self.tokens[i].text == text:
                return i
            i = self.match.get(i, i) + 1
        return None

    def _declares(self, head):
        depth = 0
        for one, two in zip(head, head[1:]):
            if one.text in OPENERS:
                return False
            depth += one.text == "<"
            depth -= one.text == ">"
            if depth == 0 and two.kind == "word" and (
                one.kind == "word" and one.text != "new"
                or one.text in (">", "&", "*") and self.text[one.start - 1] not in " \n"
            ):
                return True
            if depth == 0 and one.text == "auto" and two.text in ("&", "[", "&&", "*"):
                return True
        return False


SWITCH = """#ifndef LIMPID_MUTANT_SWITCH
#define LIMPID_MUTANT_SWITCH
#pragma GCC diagnostic ignored "-Wparentheses"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wtype-limits"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wextra"
#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
inline const int limpid_mutant_chosen = [] {
  const char* const text = getenv("LIMPID_MUTANT");
  return text ? atoi(text) : 0;
}();
inline unsigned char* const limpid_mutant_reached = [] {
  const char* const file = getenv("LIMPID_MUTANT_REACHED");
  const int there = file ? open(file, O_RDWR | O_CLOEXEC) : -1;
  void* const page = there < 0 ? MAP_FAILED : mmap(nullptr, 65536, PROT_READ | PROT_WRITE, MAP_SHARED, there, 0);
  return page == MAP_FAILED ? nullptr : static_cast<unsigned char*>(page);
}();
inline bool limpid_mutant(int number) {
  if (limpid_mutant_reached != nullptr) limpid_mutant_reached[number] = 1;
  return number == limpid_mutant_chosen;
}
#endif
"""
MOST = 65535  # numbers that fit the page above


def planted(source, mutants, path):
    """The text with these mutants in it. A mutant has number, place (of source), text (of the place)."""
    by_place = {}
    for mutant in mutants:
        by_place.setdefault(mutant.place, []).append(mutant)
    text, at = [], 0
    for place in sorted(by_place, key=lambda p: p.start):
        text += [source.text[at : place.start], _chosen(source, place, by_place[place])]
        text.append("\n" * source.text.count("\n", place.start, place.end))
        at = place.end
    text.append(source.text[at:])
    return f'{SWITCH}#line 1 "{path}"\n' + "".join(text)


def _chosen(source, place, mutants):
    own = source.code(place.start, place.end)
    if place.kind in ("expression", "return"):
        cases = " else ".join(f"if (limpid_mutant({m.number})) {{ {m.text} }}" for m in mutants)
        return f"{{ {cases} else {{ {own} }} }}"
    wrap = {"condition": "static_cast<bool>({})"}.get(place.kind) or (
        f"static_cast<{place.type}>({{}})" if place.type else "({})"
    )
    cases = "".join(f"limpid_mutant({m.number}) ? {wrap.format(m.text)} : " for m in mutants)
    return f"({cases}{wrap.format(own)})"
