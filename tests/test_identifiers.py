"""The words of the field stand in identifiers too: CONTRIBUTING says which, and this list what they replaced."""

import ast
from collections.abc import Iterator
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]

REPLACED = {
    "verdict": "outcome",
    "verdicts": "outcomes",
    "shares": "fractions",
    "ladder": "intensity levels",
    "rung": "intensity level",
    "departure": "perturbed parameter",
    "departures": "perturbed parameters",
    "foretells": "predicts",
    "pole": "pivot",
    "march": "integrate",
    "marched": "integrated",
    "lightest": "minimum effective gravity ratio",
    "closest": "distance to the unstable equilibrium",
    "thoroughness": "chatter tolerance",
    "sureness": "robustness",
    "remedy": "mitigation",
    "remedies": "mitigations",
    "doubt": "quality-control flag",
    "doubts": "quality-control flags",
    "guest": "plugin",
    "guests": "plugins",
    "house": "architecture",
    "torture": "fault injection",
    "claim": "hypothesis",
    "claims": "hypotheses",
    "ledger": "hypotheses",
    "event": "earthquake or contact event",
    "events": "earthquakes or contact events",
}
"""Words that no identifier holds, and what says it."""

NO_NAMES = {"one", "item"}
"""What no variable is called: it says nothing of what it is."""


def bound(path: Path) -> Iterator[tuple[int, str, bool]]:
    """Line and name of what a file binds, and whether it is a variable."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id, True
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.lineno, node.name, False
            for given in getattr(node, "args", ast.arguments()).__dict__.get("args", []):
                yield given.lineno, given.arg, True


def wrong(name: str, variable: bool) -> str:
    """What is wrong with an identifier, empty if nothing is."""
    plain = name.strip("_").lower()
    if variable and plain in NO_NAMES:
        return "says nothing"
    if "contact_event" in plain:
        return ""
    return next((REPLACED[part] for part in plain.split("_") if part in REPLACED), "")


def test_identifiers_hold_the_words_of_the_field():
    every = [*REPOSITORY.glob("src/rockfrag/**/*.py"), *REPOSITORY.glob("thesis/src/**/*.py")]
    # lanes of stacks are those of which one part rotates, and those of which two do
    files = [path for path in every if path.parent.name != "lanes"]
    assert len(files) > 300
    found = [
        f"{path.relative_to(REPOSITORY)}:{line}: {name}: {wrong(name, variable)}"
        for path in files
        for line, name, variable in bound(path)
        if wrong(name, variable)
    ]
    assert not found, "\n".join(found)


def test_a_wrong_identifier_is_seen():
    assert wrong("_closest_approach", True)
    assert wrong("item", True)
    assert not wrong("contact_events", True)
    assert not wrong("unstable_distance", True)
