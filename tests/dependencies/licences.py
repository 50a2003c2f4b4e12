"""Whether a package's licence expression (SPDX, or the old form `MIT/Apache-2.0`) can be satisfied with licences from a list."""

import re

# Permissive: a notice to be kept, nothing asked of what is built with it.
ALLOWED = {
    "MIT", "MIT-0", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "ISC", "Zlib", "Unlicense", "0BSD", "CC0-1.0", "BSL-1.0", "Unicode-3.0",
}  # fmt: skip
# An exception grants more than its licence does.
EXCEPTIONS = {"LLVM-exception"}
# Taken for one package each, unchanged and with the viewer only.
SINGLE = {
    "indent": {"MPL-2.0"},  # its own files stay under it
    "option-ext": {"MPL-2.0"},  # likewise
    "webpki-roots": {"CDLA-Permissive-2.0"},  # a table of certificates: data, not code
}

TOKEN = re.compile(r"\s*([()/]|[A-Za-z0-9.+-]+)")


class Unreadable(ValueError):
    """The expression is none."""


def tokens(text):
    """Words and brackets; `/` is the old way to write OR."""
    found, at = [], 0
    while text[at:].strip():
        match = TOKEN.match(text, at)
        if match is None:
            raise Unreadable(f"'{text}': cannot be read from character {at + 1}")
        found.append("OR" if match[1] == "/" else match[1])
        at = match.end()
    return found


def satisfied(text, allowed=frozenset(ALLOWED)):
    """Whether the licences in `allowed` suffice. WITH binds closest, then AND, then OR."""
    rest = tokens(text or "")
    held = either(rest, allowed)
    if rest:
        raise Unreadable(f"'{text}': '{rest[0]}' is left over")
    return held


def either(rest, allowed):
    """A OR B OR ..."""
    held = both(rest, allowed)
    while rest and rest[0] == "OR":
        rest.pop(0)
        held = both(rest, allowed) or held
    return held


def both(rest, allowed):
    """A AND B AND ..."""
    held = one(rest, allowed)
    while rest and rest[0] == "AND":
        rest.pop(0)
        held = one(rest, allowed) and held
    return held


def one(rest, allowed):
    """A licence, one WITH an exception, or an expression in brackets."""
    word = rest.pop(0) if rest else "the end"
    if word == "(":
        held = either(rest, allowed)
        if not rest or rest.pop(0) != ")":
            raise Unreadable("a bracket is not closed")
        return held
    if word in ("the end", "AND", "OR", "WITH", ")"):
        raise Unreadable(f"a licence is missing before '{word}'")
    if rest and rest[0] == "WITH":
        exception = rest[1] if len(rest) > 1 else "the end"
        del rest[:2]
        return word in allowed and exception in EXCEPTIONS
    return word in allowed


def check(packages):
    """Faults of packages as `cargo metadata` lists them."""
    faults, used = [], set()
    for package in packages:
        name, text = package["name"], package["license"]
        try:
            held = satisfied(text)
            if not held and satisfied(text, ALLOWED | SINGLE.get(name, set())):
                held = True
                used.add(name)
        except Unreadable as error:
            faults.append(f"{name} {package['version']}: licence {error}")
            continue
        if not held:
            remedy = "remedy: use another crate, or argue for the licence in tests/dependencies/licences.py"
            faults.append(f"{name} {package['version']}: licence '{text}' asks for more than the allowed ones; {remedy}")
    faults += [f"{name} stands in SINGLE of tests/dependencies/licences.py, but needs it no longer" for name in SINGLE.keys() - used]
    return faults


def self_test():
    """Expressions with a known answer."""
    right = [
        "MIT", "MIT OR GPL-3.0", "GPL-3.0 OR MIT", "MIT/GPL-3.0", "GPL-2.0 / Apache-2.0", "MIT AND ISC", "(MIT OR GPL-3.0) AND Unicode-3.0",
        "Apache-2.0 WITH LLVM-exception", "GPL-3.0 AND GPL-2.0 OR MIT", "MIT OR (GPL-3.0 AND ISC)", "((MIT))",
    ]  # fmt: skip
    wrong = [
        "GPL-3.0", "MIT AND GPL-3.0", "GPL-3.0 AND MIT", "(MIT OR ISC) AND GPL-3.0", "Apache-2.0 WITH Other-exception", "GPL-2.0 WITH LLVM-exception",
        "GPL-3.0 AND (MIT OR ISC)", "MPL-2.0", "GPL-2.0+",
    ]  # fmt: skip
    unreadable = ["", "MIT OR", "OR MIT", "MIT ISC", "(MIT", "MIT)", "MIT AND AND ISC", "MIT; ISC", "WITH MIT"]
    for text in right + wrong:
        assert satisfied(text) == (text in right), text
    for text in unreadable:
        try:
            satisfied(text)
        except Unreadable:
            continue
        raise AssertionError(f"'{text}' should be unreadable")
    assert check([{"name": n, "version": "1", "license": next(iter(s))} for n, s in SINGLE.items()]) == []
    assert len(check([{"name": "other", "version": "1", "license": "MPL-2.0"}])) == 1 + len(SINGLE)
