"""Symbolic regression (operon) of an unknown signal at one port of the calibrated simulation.

The signal is that of `latent`. It becomes an expression of the simulation's states, by genetic programming; of the
expressions of every length the one is taken that explains the recordings best for its length, its size fitted together
with the calibrated numbers.
"""

import re

from pyoperon.sklearn import SymbolicRegressor

from gp import label
from latent import Law, answer_by

SYMBOLS = "add,sub,mul,aq,constant,variable,square,abs,tanh,exp"
LENGTH = 15
POPULATION = 1000
EVALUATIONS = 400_000
MOST_S = 30


def answer(case, seed):
    """Where the signal with most evidence is, as what expression, and what that foretells on the holdout."""
    return answer_by(case, seed, expressions)


def expressions(problem, place, seed):
    """Expressions of every length for the signal there."""
    signal, states = problem.signal_and_states(place)
    regressor = genetic_programming(seed)
    regressor.fit(states, signal)

    def name(match):
        return f"[{label(problem.scaler.names[int(match[1]) - 1])}]"

    def law(model):
        words = re.sub(r"X(\d+)", name, regressor.get_model_string(model["tree"], 4))
        return Law(place, lambda q: regressor.evaluate_model(model["tree"], q), words, model["length"])

    return [law(model) for model in regressor.pareto_front_]


def genetic_programming(seed):
    """What turns values into expressions of every length."""
    return SymbolicRegressor(
        allowed_symbols=SYMBOLS,
        objectives=["r2", "length"],
        max_length=LENGTH,
        population_size=POPULATION,
        pool_size=POPULATION,
        max_evaluations=EVALUATIONS,
        max_time=MOST_S,
        optimizer_iterations=3,
        n_threads=1,
        random_state=seed,
    )
