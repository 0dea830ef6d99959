"""What a check found, and how a list of checks is printed."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Check:
    """One number against one bound: passed if value <= bound. NaN never passes."""

    name: str
    value: float
    bound: float
    what: str  # what the value is, with its unit
    applies: bool = True

    @property
    def passed(self) -> bool:
        return not self.applies or self.value <= self.bound


def not_applicable(name: str, why: str) -> Check:
    return Check(name, float("nan"), float("nan"), why, applies=False)


def table(checks: list[Check]) -> str:
    """Lines of name, value, bound, verdict and meaning."""
    width = max(len(check.name) for check in checks)
    lines = [f"{'check':{width}}  {'value':>10}  {'bound':>10}        what"]
    for check in checks:
        verdict = ("pass" if check.passed else "FAIL") if check.applies else "-"
        value, bound = (
            (f"{check.value:.3g}", f"{check.bound:.3g}") if check.applies else ("-", "-")
        )
        lines.append(f"{check.name:{width}}  {value:>10}  {bound:>10}  {verdict:4}  {check.what}")
    return "\n".join(lines)
