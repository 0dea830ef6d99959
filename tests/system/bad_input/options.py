"""Command lines that ask for absent things."""

from __future__ import annotations

from .case import Case


def _option(option: str, value: str) -> Case:
    """The option's word: a complaint may name the option or the key it is short for."""
    return Case(f"{option} {value}", lambda good: good.run(option, value), [option[2:]])


def _set(setting: str) -> Case:
    named = setting.split("=")[0] or setting
    return Case(f"--set {setting}", lambda good: good.run("--set", setting), [named])


_NUMBERS = (
    "coupling.k_vc", "coupling.b_vc", "coupling.b_v", "coupling.eta", "observer.alpha",
    "proxy.inertia_ratio", "model.inertia_error", "hand.stiffness", "hand.damping", "loop.tick",
    "device.substeps", "device.encoder_step", "device.friction", "device.damping",
    "device.torque_limit",
)  # fmt: skip
_NOT_ZERO = (
    "coupling.eta", "proxy.inertia_ratio", "model.inertia_error", "loop.tick", "device.substeps",
)  # fmt: skip

OPTIONS: list[Case] = [
    *(_option("--eta", value) for value in ("0", "-1", "nan", "inf", "small", "", "1e300")),
    *(_option("--alpha", value) for value in ("-1", "nan", "inf", "x")),
    *(_option("--coupling", value) for value in ("other", "2", "")),
    *(_option("--duration", value) for value in ("0", "-1", "nan", "inf", "soon")),
    *(_option("--seed", value) for value in ("-1", "1.5", "x", "99999999999999999999999")),
    *(_set(f"{key}={value}") for key in _NUMBERS for value in ("-1", "nan", "inf", "word")),
    *(_set(f"{key}=0") for key in _NOT_ZERO),
    _set("loop.tick=10"),
    _set("device.substeps=2.5"),
    _set("coupling.kind=other"),
    _set("observer.velocity=fast"),
    _set("observer.anti_windup=maybe"),
    _set("coupling.eta="),
    _set("coupling.eta"),
    _set("=1"),
    _set("coupling.etha=1"),
    _set("eta=1"),
    Case("an unknown command", lambda good: ["walk"], ["walk"]),
    Case("an unknown option", lambda good: [*good.run(), "--colour", "red"], ["--colour"]),
    Case("a word too many", lambda good: [*good.run(), "more"], ["more"]),
    Case("an option without its value", lambda good: [*good.run(), "--set"], ["--set"]),
    Case(
        "an option before its command",
        lambda good: ["--eta", "0.6", *good.run()],
        ["--eta"],
    ),
    Case("info without a file", lambda good: ["info"]),
    Case("recover without a file", lambda good: ["recover"]),
    Case("play without a file", lambda good: ["play"]),
    Case("devices with a word", lambda good: ["devices", "all"], ["all"]),
    *(
        Case(
            f"analyze {option} {value}",
            lambda good, option=option, value=value: ["analyze", option, value, "--json"],
            [option[2:]],
        )
        for option in ("--mass", "--band")
        for value in ("0", "-1", "nan", "inf", "x")
    ),
    Case("analyze a bad key", lambda good: ["analyze", "--set", "a.b=1", "--json"], ["a.b"]),
]
