"""A pairwise covering array: rows of levels in which each two levels of different factors, unless forbidden together, meet.

Greedy and deterministic: a row begins with a pair that no row has yet; then each factor takes the level that makes most new
pairs. Of a number of such rows, begun with different pairs, the best one is kept.
"""
import itertools
import random

import numpy as np

CANDIDATES = 8


class Levels:
    """All levels of all factors, numbered."""

    def __init__(self, factors):
        self.names = [(factor, level) for factor, levels in factors.items() for level in levels]
        self.number = {name: i for i, name in enumerate(self.names)}
        self.of_factor = [[self.number[factor, level] for level in levels] for factor, levels in factors.items()]
        self.factor = np.array([k for k, numbers in enumerate(self.of_factor) for _ in numbers])

    def pairs(self):
        """Matrix: true where two levels are of different factors."""
        return self.factor[:, None] != self.factor[None, :]

    def row(self, chosen):
        return dict(self.names[i] for i in sorted(chosen))


class Rules:
    """Which levels go together. Arc consistency looks only at factors of which some level is forbidden with another."""

    def __init__(self, levels, pairs):
        self.levels = levels
        self.forbidden = np.zeros((len(levels.names),) * 2, bool)
        for a, b in pairs:
            i, j = levels.number[a], levels.number[b]
            self.forbidden[i, j] = self.forbidden[j, i] = True
        bound = sorted({int(levels.factor[i]) for i in np.flatnonzero(self.forbidden.any(axis=0))})
        self.bound = np.flatnonzero(np.isin(levels.factor, bound))
        self.starts = [int(np.flatnonzero(levels.factor[self.bound] == k)[0]) for k in bound]
        self.bound_factors = np.array(bound, int)
        self.clear = ~self.forbidden[np.ix_(self.bound, self.bound)]

    def fitting(self, chosen, free):
        """The levels of free factors that fit to what is chosen and leave each other free factor a level."""
        fit = ~self.forbidden[chosen].any(axis=0) & np.isin(self.levels.factor, free)
        if not len(self.bound):
            return fit
        open_factors = np.isin(self.bound_factors, free)
        own = self.levels.factor[self.bound][:, None] == self.bound_factors[None, :]
        while True:
            now = fit[self.bound]
            partners = np.logical_or.reduceat(self.clear & now[None, :], self.starts, axis=1)
            left = now & (partners | own | ~open_factors[None, :]).all(axis=1)
            if (left == now).all():
                return fit
            fit[self.bound] = left


def complete(levels, uncovered, rules, start, generator):
    """A whole row from some levels, or None where the others do not fit together."""
    chosen = list(start)
    free = [k for k in range(len(levels.of_factor)) if k not in {levels.factor[i] for i in chosen}]
    while free:
        fit = rules.fitting(chosen, free)
        open_levels = {k: [i for i in levels.of_factor[k] if fit[i]] for k in free}
        if not all(open_levels.values()):
            return None
        gain = uncovered[chosen].sum(axis=0)
        # A factor with few levels left first: so that none is left without.
        tightest = min(len(found) for found in open_levels.values())
        if tightest == 1:
            k = next(k for k in free if len(open_levels[k]) == 1)
        else:
            k = max(free, key=lambda k: (max(gain[i] for i in open_levels[k]), generator.random()))
        most = max(gain[i] for i in open_levels[k])
        chosen.append(next(i for i in open_levels[k] if gain[i] == most))  # the plainest of equals
        free.remove(k)
    return chosen


def covered_by(chosen, levels):
    matrix = np.zeros((len(levels.names),) * 2, bool)
    matrix[np.ix_(chosen, chosen)] = True
    return matrix & levels.pairs()


def make_array(factors, forbidden_pairs, first_rows=(), seed=1):
    """rows, and the pairs that no row can have although no rule names them: what one of them needs is forbidden with the other."""
    levels, generator = Levels(factors), random.Random(seed)
    rules = Rules(levels, forbidden_pairs)
    uncovered = levels.pairs() & ~rules.forbidden
    rows, implied = [], []
    for start in first_rows:
        chosen = complete(levels, uncovered, rules, [levels.number[item] for item in start.items()], generator)
        if chosen is None:
            raise ValueError("a first row has a pair that is forbidden: %r" % start)
        rows.append(levels.row(chosen))
        uncovered &= ~covered_by(chosen, levels)
    while uncovered.any():
        open_pairs = np.argwhere(np.triu(uncovered))
        best, best_gain = None, 0
        for at in generator.sample(range(len(open_pairs)), min(CANDIDATES, len(open_pairs))):
            pair = [int(i) for i in open_pairs[at]]
            chosen = complete(levels, uncovered, rules, pair, generator)
            if chosen is None:
                continue
            gain = int((uncovered & covered_by(chosen, levels)).sum())
            if gain > best_gain:
                best, best_gain = chosen, gain
        if best is None:
            # None of these can be in a row; nor can others, maybe.
            for pair in open_pairs:
                best = complete(levels, uncovered, rules, [int(i) for i in pair], generator)
                if best is not None:
                    break
                implied.append(tuple(levels.names[int(i)] for i in pair))
                uncovered[pair[0], pair[1]] = uncovered[pair[1], pair[0]] = False
            if best is None:
                break
        rows.append(levels.row(best))
        uncovered &= ~covered_by(best, levels)
    return rows, implied


def count_pairs(factors):
    return sum(len(a) * len(b) for a, b in itertools.combinations(factors.values(), 2))


def pairs_of(row):
    return set(itertools.combinations(row.items(), 2))
