"""Random questions: what an answer says agrees with itself, whatever was asked.

``python -m tests.assess.test_consistency 2000`` asks as many under the default motions and prints what contradicts
itself; ``… 20 --lines`` prints the first lines, to be read aloud.
"""

import math
import random
import sys

import pytest

from rockfrag.assess.answer import RECORDS, Assessment, assess, assess_with
from rockfrag.assess.core.decisions import LEAST_CHANCE, Action
from rockfrag.assess.core.likelihood import likelihood_of
from rockfrag.assess.findings import few_earthquakes, first_screen, lines_of
from rockfrag.assess.request import make_request
from rockfrag.words.findings import Finding

from .random_requests import some_request

MOST_WORDS = 60  # Of the first screen


def faults(found: Assessment) -> list[str]:
    """What in an answer contradicts something else in it."""
    estimates = [found.rocking, found.fraction, found.probability]
    estimates += found.amplitudes.values()
    known = [each for each in estimates if each is not None]
    rocking, fraction, main = found.rocking, found.fraction, found.main
    said = []
    if not all(each.lower <= each.value <= each.upper for each in known):
        said.append("a value lies outside of its interval")
    if rocking is not None and fraction is not None:
        pairs = [(fraction.value, rocking.value), (fraction.lower, rocking.lower)]
        pairs.append((fraction.upper, rocking.upper))
        if not all(falls <= rocks for falls, rocks in pairs):
            said.append("more topple than rock")
    tenth, half = found.amplitudes[0.1], found.amplitudes[0.5]
    if not tenth.value <= half.value:
        said.append("half topple before a tenth does")
    if not found.rocks_from <= 1.15 * tenth.value:
        said.append("a tenth topple before any rocks")
    if any(math.isnan(number) for each in known for number in vars(each).values()
           if isinstance(number, float)):  # fmt: skip
        said.append("a number is none")
    decision = found.decision
    if decision is not None:
        secure = main.value > found.request.accepted
        if (decision.otherwise is Action.SECURE) != secure:
            said.append("the advice is not that of the number")
        measures = decision.action is Action.MEASURE
        if measures != (decision.chance >= LEAST_CHANCE):
            said.append("a measurement is named that turns nothing round")
    for change in found.mitigations:
        beyond = change.lower > 1 if found.main is half else change.upper < 1
        if change.shown and not (beyond and change.helps):
            said.append("a change is shown to help that may not")
    return said


def faults_of_words(found: Assessment) -> list[str]:
    """What in the first screen contradicts the numbers, or is too long."""
    words, said = " ".join(lines_of(found)), []
    if len(words.split()) > MOST_WORDS:
        said.append(f"{len(words.split())} words")
    if "decidable" in words or "nan" in words.lower() or "inf" in words.lower():
        said.append("no verdict")
    first = first_screen(found)[0]
    likelihood = dict(first.values).get("likelihood")
    if found.fraction is not None and isinstance(likelihood, Finding):
        words_are_right = likelihood.id == likelihood_of(found.fraction.value).value
        said += [] if words_are_right else ["the word is not that of the number"]
    moves = found.fraction is not None and not found.does_not_move
    if not few_earthquakes(found) and moves and not half_is_said(found):
        said.append("how far away it is, is not said")
    return said


def half_is_said(found: Assessment) -> bool:
    return any(each.id.startswith("how_far") for each in first_screen(found))


@pytest.mark.parametrize(
    ("count", "seed", "in_space"),
    [
        (12, 1, 0.1),
        *(pytest.param(500, n, 0.05, marks=pytest.mark.slow) for n in (2, 3, 4, 5)),
    ],
)
def test_random_answers_agree_with_themselves(motions, count, seed, in_space):
    rng, found = random.Random(seed), {}
    for number in range(count):
        settings = some_request(rng, in_space=in_space)
        request = make_request(settings, "test")
        brief = number % 10 > 0
        answer = assess_with(request, motions.at(request.place), brief=brief)
        said = faults(answer) + faults_of_words(answer)
        if said:
            found[number] = (settings, said, lines_of(answer))
    assert not found, found


def main(count: int, *, lines: bool) -> None:
    """Ask so many questions, and print what contradicts itself, or every answer."""
    rng, wrong = random.Random(52), 0
    for number in range(1, count + 1):
        settings = some_request(rng, in_space=0.3 if lines else 0.05)
        brief = not lines and number % 10 > 0
        found = assess(make_request(settings, "question"), RECORDS, brief=brief)
        said = faults(found) + faults_of_words(found)
        wrong += bool(said)
        if said or lines:
            print(f"{number}. {settings}\n   {' '.join(lines_of(found))} {said or ''}")
        if number % 100 == 0:
            print(f"{number} asked, {wrong} contradict themselves", flush=True)
    print(f"{count} asked, {wrong} contradict themselves", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]), lines="--lines" in sys.argv)
