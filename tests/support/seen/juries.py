"""Simulated juries: judges who choose by given strengths."""

from dataclasses import replace

import numpy as np

from seatlook.jury.questionnaire import Catch, Questionnaire, Stimulus, trials
from seatlook.jury.votes import Ballots, Vote


def stimulus(name, geometry=""):
    return Stimulus(name=name, picture=f"images/{name}.png", geometry=geometry)


def make_questionnaire(count=9, catches=4, **options):
    return Questionnaire(
        title="test",
        stimuli=tuple(stimulus(f"s{k}") for k in range(count)),
        catches=tuple(
            Catch(wrinkled=stimulus(f"deep{k}"), smooth=stimulus(f"flat{k}"))
            for k in range(catches)
        ),
        **options,
    )


def vote(questionnaire, trial, judge, theta, rng):
    """Answer one trial by Bradley-Terry; catch pairs are always right where theta is given."""
    if trial.kind == "catch":
        right = trial.left if trial.left.startswith("deep") else trial.right
        chosen = right if theta is not None else rng.choice([trial.left, trial.right])
    else:
        names = questionnaire.names
        lead = 0.0
        if theta is not None:
            lead = theta[names.index(trial.left)] - theta[names.index(trial.right)]
        chosen = trial.left if rng.random() < 1 / (1 + np.exp(-lead)) else trial.right
    return Vote(
        judge=judge,
        trial=trial.number,
        question=trial.question,
        kind=trial.kind,
        left=trial.left,
        right=trial.right,
        chosen=str(chosen),
        seconds=5.0,
    )


def ballots(questionnaire, strengths, seed=0):
    """One judge per entry of ``strengths`` (logits, or None for a coin)."""
    rng = np.random.default_rng(seed)
    votes = [
        vote(questionnaire, trial, f"judge {k}", theta, rng)
        for k, theta in enumerate(strengths)
        for trial in trials(questionnaire, 1000 * seed + k)
    ]
    return Ballots(questionnaire=questionnaire, votes=tuple(votes), problems=(), notices=())


def documents(given):
    """The files such votes would have been exported as."""
    out = {}
    for judge in given.judges:
        out[judge] = {
            "schema": 1,
            "questionnaire": given.questionnaire.digest,
            "judge": judge,
            "seed": 1,
            "votes": [
                {
                    "trial": v.trial,
                    "question": v.question,
                    "left": v.left,
                    "right": v.right,
                    "choice": {v.left: "left", v.right: "right", None: "tie"}[v.chosen],
                    "seconds": v.seconds,
                }
                for v in given.votes
                if v.judge == judge
            ],
        }
    return out


def without(given, keep):
    return replace(given, votes=tuple(v for v in given.votes if keep(v)))
