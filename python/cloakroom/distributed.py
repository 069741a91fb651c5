"""More than one machine: frames, sweeps and tiles as tasks on any Dask cluster.

``pip install './python[distributed]'`` brings Dask; a `dask.distributed.Client` of a local cluster, of machines reached by
SSH, or of a batch system (dask-jobqueue) does the work. cloakroom must be installed on the workers, and files that a
scene names must be there, too, with the same content; arrays travel with the scene.

Every result is written to a folder here as it comes, with a line in ``finished.jsonl`` that says what it is made from:
the scene, and the contents of all files and arrays that it shows or measures. What is finished is not done again when
the same call is made once more, whatever has ended the last one, unless its file has changed since; a task whose worker is
lost is given to another one.
The results are those of one machine, byte for byte.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import tempfile
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from . import _cloakroom
from ._progress import Progress, told
from .measuring import _values, sweep as sweep_here
from .pictures import Picture
from .scenes import Scene

__all__ = ["render_frames", "render_tiles", "sweep"]

#: How often a task is tried again whose worker raises something that is not the scene's fault.
_RETRIES = 2


@dataclass(frozen=True)
class _Task:
    """Work that makes the bytes of one file."""

    file: str
    scene: Scene
    #: Called as ``function(scene, *arguments)`` by a worker.
    function: Callable[..., bytes]
    arguments: tuple[Any, ...]
    #: The digests of the files that the scene names, by the keys that name them.
    inputs: dict[str, str]

    def fingerprint(self) -> str:
        """What the result depends on."""
        said = [_cloakroom.__version__, self.scene.toml, self.function.__name__, repr(self.arguments), repr(self.inputs)]
        digest = hashlib.sha256("\0".join(said).encode())
        for image in self.scene._images:
            if image is not None:
                digest.update(image.array().tobytes())
        return digest.hexdigest()


def render_tiles(
    scene: Scene,
    folder: str | os.PathLike[str],
    *,
    tile: tuple[int, int] = (512, 512),
    image_only: bool = False,
    client: Any = None,
    progress: Progress = False,
) -> Picture:
    """Renders one big picture, tile by tile.

    Parameters
    ----------
    scene : Scene
        The scene.
    folder : path
        Where the tiles are kept, ``tile-LEFT-TOP.npz`` each; made if it is not there.
    tile : (int, int), default (512, 512)
        Width and height of the tiles in pixels, even; those at the right and the lower edge may be smaller.
    image_only : bool, default False
        Only ``R``, ``G`` and ``B``, in less time.
    client : dask.distributed.Client, optional
        Who does the work; the current client if not given.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the tiles done and all tiles.

    Returns
    -------
    Picture
        The picture that ``scene.render()`` gives, byte for byte.

    Raises
    ------
    TypeError, ValueError
        If the tile is of an odd or no size, the scene cannot be, or there is no client.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; expected a Scene")
    if len(tile) != 2 or not all(isinstance(side, int) and side > 0 and side % 2 == 0 for side in tile):
        raise ValueError(f"tile is {tile!r}; expected an even width and an even height in pixels")
    width, height = scene.resolution
    corners = itertools.product(range(0, height, tile[1]), range(0, width, tile[0]))
    places = [(left, top, min(tile[0], width - left), min(tile[1], height - top)) for top, left in corners]
    inputs = _inputs(scene, {})
    tasks = [
        _Task(f"tile-{place[0]:05}-{place[1]:05}.npz", scene, _tile, (place, image_only), inputs) for place in places
    ]
    files = _run(tasks, Path(folder), client, progress, "rendering tiles")
    return Picture.merge(files, **scene._native.map)


def render_frames(
    scene: Scene,
    keys: Mapping[str, Sequence[Any] | NDArray[Any]],
    folder: str | os.PathLike[str],
    *,
    ending: str = ".png",
    client: Any = None,
    progress: Progress = False,
) -> list[Path]:
    """Renders the frames of an animation.

    Parameters
    ----------
    scene : Scene
        The scene.
    keys : mapping of str to sequence
        The values that keys take from frame to frame, as many for each key: ``{"device.0.rotation": range(91)}``.
    folder : path
        Where the frames go, ``frame-00000.png`` and so on; made if it is not there.
    ending : {".png", ".exr", ".npz"}, default ".png"
        The kind of the files.
    client : dask.distributed.Client, optional
        Who does the work; the current client if not given.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the frames done and all frames.

    Returns
    -------
    list of Path
        The files, in the order of the frames.

    Raises
    ------
    TypeError, ValueError
        If a key does not exist, the keys have not as many values each, a scene cannot be, or there is no client.
    """
    values = _swept(scene, keys)
    counts = {key: len(given) for key, given in values.items()}
    if len(set(counts.values())) != 1:
        raise ValueError(f"keys have {counts} values; expected as many for each, and one key at least")
    if ending not in (".png", ".exr", ".npz"):
        raise ValueError(f"ending is {ending!r}; expected .png, .exr or .npz")
    steps = [dict(zip(values, step)) for step in zip(*values.values())]
    digests: dict[str, str] = {}
    tasks = []
    for number, step in enumerate(steps):
        shown = scene.replace(step)
        tasks.append(_Task(f"frame-{number:05}{ending}", shown, _frame, (ending,), _inputs(shown, digests)))
    return _run(tasks, Path(folder), client, progress, "rendering frames")


def sweep(
    scene: Scene,
    keys: Mapping[str, Sequence[Any] | NDArray[Any]],
    folder: str | os.PathLike[str],
    *,
    client: Any = None,
    progress: Progress = False,
) -> list[dict[str, Any]]:
    """Measures how well the devices of a scene work, for every combination of the values of some keys.

    Parameters
    ----------
    scene, keys
        As `cloakroom.sweep` takes them.
    folder : path
        Where the figures of each combination go, ``sweep-00000.json`` and so on; made if it is not there.
    client : dask.distributed.Client, optional
        Who does the work; the current client if not given.
    progress : bool or callable, default False
        ``True`` for a line on standard error, or a function that is called with the combinations done and all of them.

    Returns
    -------
    list of dict
        For each combination, the last key running fastest, the value of every key and the figures of
        ``cloakroom quality``; NaN where there is none.

    Raises
    ------
    TypeError, ValueError
        If a key does not exist, a value does not fit, or there is no client.
    """
    values = _swept(scene, keys)
    digests: dict[str, str] = {}
    tasks = []
    for number, combination in enumerate(itertools.product(*values.values())):
        step = dict(zip(values, combination))
        measured = scene.replace(step)
        inputs = _inputs(measured, digests)
        tasks.append(_Task(f"sweep-{number:05}.json", measured, _measured, (step,), inputs))
    files = _run(tasks, Path(folder), client, progress, "measuring")
    return [json.loads(file.read_text(encoding="utf-8")) for file in files]


def _swept(scene: Scene, keys: Mapping[str, Any]) -> dict[str, list[Any]]:
    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; expected a Scene")
    if not isinstance(keys, Mapping):
        raise TypeError(f"keys is a {type(keys).__name__}; expected a mapping of keys to lists of values")
    return {key: _values(key, given) for key, given in keys.items()}


def _inputs(scene: Scene, digests: dict[str, str]) -> dict[str, str]:
    """The digests of the files that a scene names, by the keys that name them; ``digests`` keeps those known by name."""
    for _, path in scene._native.files:
        if path not in digests:
            digests[path] = hashlib.sha256(Path(path).read_bytes()).hexdigest()
    return {key: digests[path] for key, path in scene._native.files}


# What workers do.


def _tile(scene: Scene, place: tuple[int, int, int, int], image_only: bool) -> bytes:
    return _saved(scene.render(image_only=image_only, tile=place), ".npz")


def _frame(scene: Scene, ending: str) -> bytes:
    image_only = ending == ".png" and "map" not in scene._native.map
    return _saved(scene.render(image_only=image_only), ending)


def _measured(scene: Scene, step: dict[str, Any]) -> bytes:
    figures = {name: float(array) for name, array in sweep_here(scene, {}).items()}
    return json.dumps({**step, **figures}).encode()


def _saved(picture: Picture, ending: str) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / ("picture" + ending)
        picture.save(file)
        return file.read_bytes()


def _work(scene: Scene, function: Callable[..., bytes], arguments: tuple[Any, ...], inputs: dict[str, str]) -> bytes:
    """Runs in a worker: as many threads as the worker is given, and files of the same content."""
    from distributed import get_worker

    threads = get_worker().state.nthreads
    if _cloakroom.threads() != threads:
        _cloakroom.set_threads(threads)
    result = function(scene, *arguments)
    for key, digest in _inputs(scene, {}).items():
        if inputs[key] != digest:
            path = dict(scene._native.files)[key]
            raise ValueError(f"{key}: {path} has changed, or is another file on a worker; begin again with the same file")
    return result


def _same(scene: Scene) -> Scene:
    return scene


# What is done here.


def _run(tasks: list[_Task], folder: Path, client: Any, progress: Progress, what: str) -> list[Path]:
    """Has the tasks done that are not finished yet."""
    folder.mkdir(parents=True, exist_ok=True)
    record = folder / "finished.jsonl"
    finished = dict(_finished(record))
    fingerprints = {task.file: task.fingerprint() for task in tasks}
    waiting = [
        task
        for task in tasks
        if finished.get(task.file) != (fingerprints[task.file], _digest(folder / task.file))
    ]
    with told(progress, what) as tell:
        done = len(tasks) - len(waiting)
        if tell is not None:
            tell(done, len(tasks))
        # Closed at once where something is raised here: tasks that nobody waits for are given up.
        with closing(_results(waiting, client)) as results, record.open("a", encoding="utf-8") as lines:
            # A line that was cut short ends here.
            lines.write("\n")
            for task, result in results:
                _write(folder / task.file, result)
                entry = {"file": task.file, "fingerprint": fingerprints[task.file], "result": _sha256(result)}
                lines.write(json.dumps(entry) + "\n")
                lines.flush()
                done += 1
                if tell is not None:
                    tell(done, len(tasks))
    return [folder / task.file for task in tasks]


def _finished(record: Path) -> Iterator[tuple[str, tuple[str, str]]]:
    """Files, their fingerprints and the digests of what was written; a line that was cut short is none."""
    if record.exists():
        for line in record.read_text(encoding="utf-8").splitlines():
            try:
                entry = json.loads(line)
                yield entry["file"], (entry["fingerprint"], entry["result"])
            except (ValueError, KeyError, TypeError):
                continue


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _digest(file: Path) -> str | None:
    """The digest of what is in a file; none if it cannot be read."""
    try:
        return _sha256(file.read_bytes())
    except OSError:
        return None


def _write(file: Path, content: bytes) -> None:
    """The file is there whole or not at all."""
    unfinished = file.with_name(file.name + ".part")
    unfinished.write_bytes(content)
    os.replace(unfinished, file)


def _results(tasks: list[_Task], client: Any) -> Generator[tuple[_Task, bytes], None, None]:
    """Tasks and the bytes of their files, as they come."""
    if not tasks:
        return
    try:
        from distributed import Client, as_completed, get_client
    except ImportError:
        raise ImportError("cloakroom.distributed needs Dask: pip install './python[distributed]'") from None
    if client is None:
        try:
            client = get_client()
        except ValueError:
            raise ValueError("there is no Dask client; make one, as in dask.distributed.Client()") from None
    if not isinstance(client, Client):
        raise TypeError(f"client is a {type(client).__name__}; expected a dask.distributed.Client")
    # A scene is a task, too: where the worker that holds it is lost, the scheduler makes it once more.
    scenes: dict[int, Any] = {}
    futures: dict[Any, _Task] = {}
    for task in tasks:
        if id(task.scene) not in scenes:
            scenes[id(task.scene)] = client.submit(_same, task.scene, pure=False)
        scene = scenes[id(task.scene)]
        future = client.submit(_work, scene, task.function, task.arguments, task.inputs, pure=False, retries=_RETRIES)
        futures[future] = task
    scenes.clear()
    waiting = as_completed(list(futures))  # type: ignore[no-untyped-call]
    try:
        for future in waiting:
            task = futures.pop(future)
            yield task, future.result()
            # The worker may forget it.
            future.release()
    finally:
        client.cancel(list(futures))  # type: ignore[no-untyped-call]
