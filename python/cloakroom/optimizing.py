"""Finding the values of a scene's keys at which something is best."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._progress import Progress, told
from .labelled import Arrays
from .scenes import Scene

__all__ = ["Optimum", "optimize"]


@dataclass(frozen=True)
class Optimum:
    """The best that has been found."""

    #: The values of the keys.
    values: dict[str, float]
    #: The scene with these values.
    scene: Scene
    #: What the objective is there: its number, or half the sum of its squares.
    value: float
    #: Whether the last steps were within the tolerance.
    converged: bool
    #: What ended the search, in words.
    message: str
    #: Every evaluation in its order: the values of each key, and the objective as ``"value"``; infinite where there is
    #: no such scene.
    history: Arrays


#: A search that has come to so much of what it has begun with is near the bottom.
_NEAR = 1e-4


class _Enough(Exception):
    """As many evaluations as are allowed."""


class _Failed(Exception):
    """The objective has failed; scipy would take its error for one of its own."""

    def __init__(self, error: Exception) -> None:
        super().__init__(str(error))
        self.error = error


class _Search:
    """Evaluates an objective at points of the unit box that the bounds of the keys are."""

    def __init__(
        self,
        build: Callable[[dict[str, float]], Scene],
        bounds: dict[str, tuple[float, float]],
        objective: Callable[..., Any],
        seed: int,
        most: int,
        tell: Callable[[int, int], object] | None,
    ) -> None:
        self.build, self.bounds, self.seed, self.most, self.tell = build, bounds, seed, most, tell
        self.objective, self.takes_random = objective, _parameters(objective) > 1
        self.points: list[NDArray[np.float64]] = []
        self.costs: list[float] = []
        #: How many residuals there are; none for an objective that is a number.
        self.residuals: int | None = None
        #: Why the last values that make no scene make none.
        self.refused: ValueError | None = None

    def values(self, point: NDArray[np.float64]) -> dict[str, float]:
        shares = zip(np.clip(point, 0, 1), self.bounds.items())
        return {key: float(low + share * (high - low)) for share, (key, (low, high)) in shares}

    def evaluate(self, point: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """What the objective gives, ``None`` where there is no such scene."""
        if len(self.points) >= self.most:
            raise _Enough
        found = None
        try:
            scene = self.build(self.values(point))
            scene._native.build()
        except ValueError as error:
            self.refused = error
        else:
            random = (np.random.default_rng(self.seed),) if self.takes_random else ()
            try:
                found = _numbers_of(self.objective(scene, *random))
            except (TypeError, ValueError, RuntimeError) as error:
                raise _Failed(error) from error
            if found.ndim == 1:
                if self.residuals not in (None, len(found)):
                    raise ValueError(f"objective gives {len(found)} residuals, and gave {self.residuals} before")
                self.residuals = len(found)
        self.points.append(np.clip(point, 0, 1))
        cost = np.inf if found is None else float(found) if found.ndim == 0 else 0.5 * float(found @ found)
        self.costs.append(cost)
        if self.tell is not None:
            self.tell(len(self.points), self.most)
        return found

    def cost(self, point: Any) -> float:
        self.evaluate(np.atleast_1d(np.asarray(point, np.float64)))
        return self.costs[-1]

    def residual(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        found = self.evaluate(point)
        # Worse than all that is there, so that no step goes there.
        worst = max((cost for cost in self.costs if cost < np.inf), default=1.0)
        return found if found is not None else np.full(self.residuals or 1, 1e3 * np.sqrt(worst + 1e-300))

    def is_near(self) -> bool:
        """Whether going down by residuals, which needs few steps, may take over."""
        finite = [cost for cost in self.costs if cost < np.inf]
        return self.residuals is not None and min(finite, default=np.inf) < _NEAR * float(np.median(finite[:100]))

    def best(self) -> NDArray[np.float64]:
        return self.points[int(np.argmin(self.costs))]


def optimize(
    scene: Scene | Callable[[dict[str, float]], Scene],
    keys: Mapping[str, tuple[float, float]],
    objective: Callable[..., Any],
    *,
    start: Mapping[str, float] | None = None,
    tolerance: float = 1e-9,
    most_evaluations: int = 5_000,
    seed: int = 0,
    progress: Progress = False,
) -> Optimum:
    """Finds the values of keys, within bounds, at which an objective is least; needs ``pip install './python[optimize]'``.

    With a `start` the search goes down from there. Without one it looks everywhere first, by differential evolution.
    Going down is the method of Levenberg and Marquardt within bounds (scipy's ``least_squares``) if the objective
    gives residuals, which is by far the most exact, else that of Nelder and Mead.

    Parameters
    ----------
    scene : Scene or callable
        The scene; or, where a value stands in several keys, a function that makes the scene of a dict of values. Values
        of which no scene can be made (``ValueError``) are passed over.
    keys : mapping of str to (float, float)
        The keys, as `Scene.replace` takes them, with their least and greatest values: ``{"device.0.kappa": (0.3,
        0.8)}``. For a function, names of one's own.
    objective : callable
        What is to be least: a function of a scene that gives a number, or residuals (N,), of which half the sum of squares
        is to be least. If it has a second parameter without a default, it is given a `numpy.random.Generator`, the same
        one at each evaluation: rays that are drawn by it are the same, and differences are those of the scenes alone.
    start : mapping of str to float, optional
        Where to begin.
    tolerance : float, default 1e-9
        The search ends where steps are smaller than this share of the bounds.
    most_evaluations : int, default 5000
        It ends, too, after so many evaluations.
    seed : int, default 0
        That of all random numbers.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the evaluations done and the most that
        there may be.

    Returns
    -------
    Optimum
        The values, the scene with them, and every evaluation.

    Raises
    ------
    TypeError, ValueError
        If a bound or the start makes no sense, no scene could be made at all or by the start alone (as of a key that
        takes whole numbers), or the objective gives no finite numbers.
    ImportError
        If scipy is not installed.

    Examples
    --------
    What leaves the cloak (iii) is the same for any kappa, but not how far its light makes way inside:

    >>> import numpy as np
    >>> from cloakroom import Scene, SquareCloak, optimize, trace
    >>> def height(scene):
    ...     way = trace(scene, [-20, 3, 0], [1, 0, 0], paths=True).paths.to_leaf(0)
    ...     return np.interp([-5, 0, 5], way[:, 0], way[:, 1])
    >>> scene = Scene(devices=SquareCloak())
    >>> measured = height(scene)
    >>> found = optimize(
    ...     scene,
    ...     {"device.0.kappa": (0.3, 0.8)},
    ...     lambda scene: height(scene) - measured,
    ...     start={"device.0.kappa": 0.5},
    ... )
    >>> round(found.values["device.0.kappa"], 7), round(3**-0.5, 7)
    (0.5773503, 0.5773503)
    """
    try:
        solvers = import_module("scipy.optimize")
    except ImportError:
        raise ImportError("scipy is not installed; pip install './python[optimize]' brings it") from None
    if isinstance(scene, Scene):
        build: Callable[[dict[str, float]], Scene] = scene.replace
    elif callable(scene):
        build = scene
    else:
        raise TypeError(f"scene is a {type(scene).__name__}; expected a Scene or a function that makes one")
    bounds = _bounds(keys)
    begin = None if start is None else _start(start, bounds)
    if not 0 < tolerance < 1:
        raise ValueError(f"tolerance is {tolerance}; expected a share of the bounds between 0 and 1")
    with told(progress, "optimizing") as tell:
        search = _Search(build, bounds, objective, seed, most_evaluations, tell)
        try:
            converged, message = _run(solvers, search, begin, tolerance)
        except _Failed as failed:
            raise failed.error from None
        except _Enough:
            converged, message = False, f"{most_evaluations} evaluations, which is most_evaluations, were not enough"
    if not np.isfinite(min(search.costs, default=np.inf)):
        build(search.values(search.points[0] if search.points else np.full(len(bounds), 0.5)))._native.build()
        raise ValueError("none of the values tried makes a scene; mend the bounds in keys")
    made = {tuple(point) for point, cost in zip(search.points, search.costs) if np.isfinite(cost)}
    if search.refused is not None and begin is not None and made == {tuple(begin)}:
        raise ValueError(f"of the values tried only the start makes a scene: {search.refused}")
    values = search.values(search.best())
    columns = {key: np.array([search.values(point)[key] for point in search.points]) for key in bounds}
    columns["value"] = np.array(search.costs)
    history = Arrays(columns, dict.fromkeys(columns, ("evaluation",)))
    return Optimum(values, build(values), min(search.costs), converged, message, history)


def _run(solvers: Any, search: _Search, begin: NDArray[np.float64] | None, tolerance: float) -> tuple[bool, str]:
    """Searches; whether it has converged, and what ended it."""
    count = len(search.bounds)
    if begin is None:
        solvers.differential_evolution(
            search.cost, [(0.0, 1.0)] * count, seed=search.seed, polish=False, tol=1e-3, atol=1e-12, init="sobol",
            callback=lambda point, convergence: search.is_near(),
        )  # fmt: skip
        begin = search.best()
    elif not np.isfinite(search.cost(begin)):
        search.build(search.values(begin))._native.build()
    if search.residuals is not None:
        # Within the bounds by a hair, from which derivatives may be taken on either side.
        inside = np.clip(begin, 1e-9, 1 - 1e-9)
        result = solvers.least_squares(
            search.residual, inside, bounds=(0.0, 1.0), jac="3-point", xtol=tolerance, ftol=1e-15, gtol=1e-15
        )
    else:
        result = solvers.minimize(
            search.cost, begin, method="Nelder-Mead", bounds=[(0.0, 1.0)] * count,
            options={"xatol": tolerance, "fatol": np.inf, "maxfev": search.most, "maxiter": search.most},
        )  # fmt: skip
    return bool(result.success), str(result.message)


def _parameters(objective: Any) -> int:
    """How many values a function must be given."""
    if not callable(objective):
        raise TypeError(f"objective is a {type(objective).__name__}; expected a function of a scene")
    try:
        takes = inspect.signature(objective).parameters.values()
    except ValueError:
        return 1
    kinds = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    places = [each for each in takes if each.kind in kinds]
    if not places and all(each.kind != each.VAR_POSITIONAL for each in takes):
        raise TypeError("objective takes nothing; expected a function of a scene, and of a numpy.random.Generator if it "
                        "draws")  # fmt: skip
    return sum(each.default is each.empty for each in places)


def _numbers_of(given: Any) -> NDArray[np.float64]:
    """What an objective has given: a number, or residuals."""
    expected = "expected a finite number, or finite residuals (N,)"
    try:
        found = np.asarray(given, np.float64) if given is not None else None
    except (TypeError, ValueError):
        found = None
    if found is None:
        raise ValueError(f"objective gives {given!r}; {expected}")
    if found.ndim > 1 or found.size == 0:
        raise ValueError(f"objective gives an array of the shape {found.shape}; {expected}")
    if not np.isfinite(found).all():
        raise ValueError(f"objective gives {found}; {expected}")
    return found


def _bounds(keys: Any) -> dict[str, tuple[float, float]]:
    if not isinstance(keys, Mapping):
        raise TypeError(f"keys is a {type(keys).__name__}; expected a mapping of keys to least and greatest values")
    if not keys:
        raise ValueError("keys is empty; expected one key at least")
    bounds = {}
    for key, given in keys.items():
        pair = np.asarray(given)
        if pair.shape != (2,) or pair.dtype.kind not in "iuf" or not np.isfinite(pair).all() or pair[0] >= pair[1]:
            raise ValueError(f"keys[{key!r}] is {given!r}; expected its least and its greatest value")
        bounds[key] = (float(pair[0]), float(pair[1]))
    return bounds


def _start(start: Any, bounds: dict[str, tuple[float, float]]) -> NDArray[np.float64]:
    if not isinstance(start, Mapping) or set(start) != set(bounds):
        raise ValueError(f"start is {start!r}; expected a value for each of {', '.join(bounds)}")
    for key, (low, high) in bounds.items():
        if not low <= start[key] <= high:
            raise ValueError(f"start[{key!r}] is {start[key]}; expected it within its bounds, {low} to {high}")
    return np.array([(start[key] - low) / (high - low) for key, (low, high) in bounds.items()], np.float64)
