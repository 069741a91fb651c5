"""The plugins of Mitsuba: the BSDF that is a device, and the path tracer that takes rays through devices."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np
from numpy.typing import NDArray

from ..scatterers import LEFT, MISSED, Scatterer, rigid
from ._shape import MARGIN, MIN_POWER, Box, box_of, keys_of, scatterer_of

__all__ = ["register"]

#: Shadow rays through devices that each path may have waiting; where there are more, the path waits for them.
SLOTS = 4

#: Paths at a time, unless the picture alone has more; in polarized variants each carries Mueller matrices.
PATHS, PATHS_POLARIZED = 1 << 20, 1 << 17

#: A device lets shadow rays through by itself that takes at least so much of the light on along its line.
CLEAR = 0.9

#: Rays that find out how much that is, and that look for furniture within devices.
TRIALS = 4096

#: The ends of the wavelengths at which devices are traced by themselves; what is beyond goes with the next one.
SHORTEST_NM, LONGEST_NM = 400.0, 700.0

#: Arrays of Dr.Jit begin at multiples of so many bytes.
ALIGNED = 64

#: What a BSDF that is a device has among the parameters of a scene.
MARK = "scatterer"

#: Variants in which the plugins are registered.
_registered: set[str] = set()


def register() -> None:
    """Registers the plugins in the current variant, once; in variants without wavefronts such that say so."""
    variant = mi.variant()
    if variant is None or variant in _registered:
        return
    bsdf, integrator = _refused(variant), _refused(variant)
    if variant.startswith(("llvm_", "cuda_")):
        bsdf, integrator = _bsdf(), _integrator()
    mi.register_bsdf("cloakroom", bsdf)
    mi.register_integrator("cloakroom_path", integrator)
    _registered.add(variant)


def _refused(variant: str) -> Callable[[Any], Any]:
    def refuse(_: Any) -> Any:
        raise ValueError(
            f"{variant} traces rays one by one, and devices many at a time: take a variant that computes wavefronts, such as llvm_ad_rgb"
        )

    return refuse


def _bsdf() -> Callable[[Any], Any]:
    class Cloakroom(mi.BSDF):  # type: ignore[misc]
        """A device on the shape that bounds it. Other integrators than ``cloakroom_path`` see nothing there."""

        def __init__(self, props: Any) -> None:
            super().__init__(props)
            plain = {name: props[name] for name in props.keys()}
            to_world = plain.pop("to_world", None)
            matrix = np.eye(4) if to_world is None else np.array(to_world.matrix, dtype=np.float64).reshape(4, 4)
            unit = float(plain.pop("unit", 1.0))
            of_light = "wavelength_nm" in plain
            wavelength_nm, min_power = float(plain.pop("wavelength_nm", 550.0)), float(plain.pop("min_power", MIN_POWER))
            self.see_through = plain.pop("see_through", "auto")
            if self.see_through not in ("auto", "yes", "no"):
                raise ValueError(f'see_through is {self.see_through!r}; expected "auto", "yes" or "no"')
            bins = int(plain.pop("wavelengths", 1))
            if bins < 1:
                raise ValueError(f"wavelengths is {bins}; expected 1, which is wavelength_nm for all colors, or more")
            if bins > 1 and not mi.is_spectral:
                raise ValueError(
                    f"wavelengths is {bins}, but {mi.variant()} traces red, green and blue together; each color takes its own "
                    "way through a device in spectral variants, such as llvm_ad_spectral"
                )
            matrix = rigid("to_world", matrix)
            keys = keys_of(plain)
            if "scene" in keys:
                keys["scene"] = str(mi.file_resolver().resolve(keys["scene"]))
            self.scatterer = scatterer_of(keys, matrix, unit, wavelength_nm, min_power, of_light=of_light)
            # One for each of so many equal bins of wavelengths, at its middle; or one for all.
            self.scatterers = [self.scatterer]
            if bins > 1:
                at = SHORTEST_NM + (LONGEST_NM - SHORTEST_NM) * (np.arange(bins) + 0.5) / bins
                self.scatterers = [scatterer_of(keys, matrix, unit, each, min_power, of_light=True) for each in at.tolist()]
            # Endless ones are refused here.
            self.box = box_of(self.scatterer)
            self.m_flags = mi.BSDFFlags.Null | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
            self.m_components = [self.m_flags]

        def sample(self, ctx: Any, si: Any, sample1: Any, sample2: Any, active: Any = True) -> Any:
            bs = dr.zeros(mi.BSDFSample3f)
            bs.wo = -si.wi
            bs.pdf = mi.Float(1)
            bs.eta = mi.Float(1)
            bs.sampled_type = mi.UInt32(+mi.BSDFFlags.Null)
            bs.sampled_component = mi.UInt32(0)
            return bs, dr.select(active, mi.Spectrum(1), mi.Spectrum(0))

        def eval(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            return mi.Spectrum(0)

        def pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            return mi.Float(0)

        def eval_pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            return mi.Spectrum(0), mi.Float(0)

        def eval_null_transmission(self, si: Any, active: Any = True) -> Any:
            return mi.Spectrum(1)

        def traverse(self, callback: Any) -> None:
            # By this it is found wherever it is in a scene.
            callback.put(MARK, self.scatterer, mi.ParamFlags.NonDifferentiable)

        def to_string(self) -> str:
            return f"Cloakroom[{self.scatterer}]"

    return Cloakroom


class _Room:
    """The devices of a scene, and how to know them from its other shapes."""

    def __init__(self, scene: Any) -> None:
        #: Of each device one scatterer for all light, or one for each of equal bins of wavelengths.
        self.scatterers: list[list[Scatterer]] = []
        self.clear: list[bool] = []
        self.shapes = _bounding(scene)
        self.boxes: list[Box] = []
        numbers: dict[int, int] = {}
        # Paths never hit such a lamp: what shadow rays do not bring is lost.
        has_points = any(mi.has_flag(lamp.flags(), mi.EmitterFlags.Delta) for lamp in scene.emitters())
        for number, shape in enumerate(self.shapes, 1):
            bsdf = shape.bsdf()
            self.scatterers.append(bsdf.scatterers)
            self.boxes.append(bsdf.box)
            numbers[_place(shape)] = number
            self.clear.append(bsdf.see_through == "yes" or bsdf.see_through == "auto" and (has_points or _is_clear(bsdf)))
        self.check_bounds()
        self.check_all_found(scene)
        if self.shapes:
            self._check_merged(scene)
            table = np.zeros(max(numbers) + 1, dtype=np.uint32)
            for place, number in numbers.items():
                table[place] = number
            self.table = mi.UInt32(table)
            self.clear_table = mi.Bool([False, *self.clear])
            self._check_inside(scene)

    def check_bounds(self) -> None:
        """Refuses shapes that do not hold their devices, or do no longer."""
        for shape, box in zip(self.shapes, self.boxes):
            bounds = shape.bbox()
            low, high = np.array(bounds.min).ravel(), np.array(bounds.max).ravel()
            middle, reach = box.to_world[:3, 3], box.extent
            # It has been grown; single numbers are off by less.
            if (middle - reach < low).any() or (middle + reach > high).any():
                raise ValueError(
                    f"the shape {shape.id()!r} does not hold its device: it goes from {low} to {high}, and the device from "
                    f"{middle - reach} to {middle + reach}; cloakroom.mitsuba.device() makes a shape that does"
                )

    def check_all_found(self, scene: Any) -> None:
        """Refuses devices that are not on shapes of the scene themselves, where nobody would see them."""
        marks = [name for name in mi.traverse(scene).keys() if name.split(".")[-1] == MARK]
        if len(marks) > len({id(shape.bsdf()) for shape in self.shapes}):
            here = {f"{shape.id()}.bsdf.{MARK}" for shape in self.shapes}
            hidden = [name.removesuffix(f".{MARK}") for name in marks if name not in here]
            raise ValueError(
                f"the device {' or '.join(hidden)} is within another BSDF or a group of shapes that is instanced: put its "
                "bounding shape into the scene itself"
            )

    @staticmethod
    def _check_merged(scene: Any) -> None:
        """Refuses meshes without bounds in light from afar: shadow rays to it go as far as the bounds of the scene say."""
        afar = any(mi.has_flag(lamp.flags(), mi.EmitterFlags.Infinite) for lamp in scene.emitters())
        if afar and not all(shape.bbox().valid() for shape in scene.shapes()):
            raise ValueError(
                "Mitsuba has made one mesh of several and lost its bounds, so that light of the sky or the sun would be wrong: "
                "load the scene with optimize=False"
            )

    def _check_inside(self, scene: Any) -> None:
        """Refuses what stands within the bounds of a device: lamps that are points, and shapes, by rays from side to side."""
        rng = np.random.default_rng(0)
        for shape, box in zip(self.shapes, self.boxes):
            for lamp in scene.emitters():
                if mi.has_flag(lamp.flags(), mi.EmitterFlags.DeltaPosition) and box.holds(np.array(lamp.bbox().center()).ravel()):
                    raise ValueError(f"a lamp stands in the bounding shape {shape.id()!r} of a device, where no light is traced")
            # Furniture may touch the device, and be within rounding of it.
            placed, ends = box.shape(-10 * MARGIN), []
            for _ in range(2):
                points = rng.uniform(-1, 1, (3, TRIALS))
                points /= np.linalg.norm(points, axis=0) if box.ball else np.abs(points).max(axis=0)
                ends.append(placed[:3, :3] @ points + placed[:3, 3:])
            start, end = (mi.Point3f(points.astype(np.float32)) for points in ends)
            way = end - start
            length = dr.norm(way)
            ray = mi.Ray3f(start, way / length)
            ray.maxt = length
            found = scene.ray_intersect_preliminary(ray, False, length > 0)
            hit = found.is_valid()
            if dr.any(hit):
                first = int(np.flatnonzero(np.array(hit))[0])
                at = np.array(ray.o + ray.d * found.t)[:, first].round(4).tolist()
                raise ValueError(
                    f"something reaches into the bounding shape {shape.id()!r} of a device, at {at}: shapes may touch it, "
                    "but not stand in it"
                )

    def number(self, shape: Any, active: Any) -> Any:
        """The number of the device, counted from 1, that a shape bounds; else 0."""
        place = dr.reinterpret_array(mi.UInt32, shape)
        known = active & (place < dr.width(self.table))
        return dr.select(known, dr.gather(mi.UInt32, self.table, place, known), 0)


def _bounding(scene: Any) -> list[Any]:
    """The shapes of a scene that bound devices."""
    return [shape for shape in scene.shapes() if hasattr(shape.bsdf(), "scatterer")]


def _place(shape: Any) -> int:
    """The number that arrays of shapes have for one."""
    return int(dr.reinterpret_array(mi.UInt32, mi.ShapePtr(shape))[0])


def _scatter(scatterers: list[Scatterer], o: Any, d: Any, u: Any, wavelengths: Any) -> dict[str, NDArray[Any]]:
    """What becomes of rays at a device, of each by the bin of its first wavelength."""
    names = ["status", "straight", "position", "direction", "weight", "transmitted"]
    starts, ways, draws = _rows(o), _rows(d), np.array(u)
    fields: Any = False
    if mi.is_polarized:
        names.append("electric_field")
        fields = np.stack([_rows(axis) for axis in _frame(d)], axis=1)
    if len(scatterers) == 1:
        (scatterer,) = scatterers
        scattered = scatterer.scatter(starts, ways, draws, fields=fields)
        return {name: getattr(scattered, name) for name in names}
    share = (np.array(wavelengths) - SHORTEST_NM) / (LONGEST_NM - SHORTEST_NM)
    bins = np.clip((share * len(scatterers)).astype(int), 0, len(scatterers) - 1)
    found: dict[str, NDArray[Any]] = {}
    for number in np.unique(bins):
        own = bins == number
        fields_there = fields[own] if mi.is_polarized else False
        scattered = scatterers[number].scatter(starts[own], ways[own], draws[own], fields=fields_there)
        for name in names:
            part = getattr(scattered, name)
            found.setdefault(name, np.empty((len(draws), *part.shape[1:]), part.dtype))[own] = part
    return found


def _frame(d: Any) -> tuple[Any, Any]:
    """The axes that Mitsuba's Stokes vectors have of light that comes along camera rays, so against their direction."""
    x = mi.mueller.stokes_basis(-d)
    return x, dr.cross(x, d)


def _mueller(scattered: dict[str, NDArray[Any]], d: Any) -> Any:
    """The Mueller matrices of leaves that were drawn for rays along ``d``, for light that comes against them.

    They are scaled to the weights of the leaves. All media are reciprocal, so that the Jones matrix of light is that of the
    ray from the camera transposed (the book's chapter about polarization).
    """
    columns = [
        [_columns(mi.Vector3f, part(scattered["electric_field"][:, column]).astype(np.float32)) for part in (np.real, np.imag)]
        for column in range(2)
    ]
    axes = _frame(_columns(mi.Vector3f, scattered["direction"]))

    def jones(of: int, to: int) -> Any:
        re, im = columns[to]
        return mi.Complex2f(dr.dot(axes[of], re), dr.dot(axes[of], im))

    # E of what arrives is ((a, b), (c, d)) E of what set out.
    xx, xy, yx, yy = jones(0, 0), jones(1, 0), jones(0, 1), jones(1, 1)
    a, b, c, e = (dr.squared_norm(each) for each in (xx, xy, yx, yy))

    def mutual(one: Any, other: Any) -> Any:
        return dr.conj(one) * other

    before, after = (mutual(xx, xy), mutual(yx, yy)), (mutual(xx, yx), mutual(xy, yy))
    one, other = mutual(xx, yy), mutual(xy, yx)
    power = 0.5 * (a + b + c + e)
    # In fields that go as exp(-i w t) light of E = (1, i) turns counterclockwise as it is seen to come, left-handed; Mitsuba
    # counts right-handed light as S3 > 0.
    rows = [
        [power, 0.5 * (a - b + c - e), (before[0] + before[1]).real, (before[0] + before[1]).imag],
        [0.5 * (a + b - c - e), 0.5 * (a - b - c + e), (before[0] - before[1]).real, (before[0] - before[1]).imag],
        [(after[0] + after[1]).real, (after[0] - after[1]).real, (one + other).real, (one - other).imag],
        [-(after[0] + after[1]).imag, -(after[0] - after[1]).imag, -(one + other).imag, (one - other).real],
    ]
    scale = _array(mi.Float, scattered["weight"]) / power
    return mi.Spectrum(mi.Matrix4f(rows)) * dr.select(power > 0, scale, 0)


def _first_only(light: Any, alone: Any) -> Any:
    """Light of which only the first wavelength goes on, for all others; ``alone`` says where that has been done."""
    first = mi.Spectrum(0)
    if mi.is_polarized:
        for row, column in itertools.product(range(4), range(4)):
            entry = mi.UnpolarizedSpectrum(0)
            entry[0] = light[row, column][0] * dr.select(alone, 1, len(entry))
            first[row, column] = entry
    else:
        first[0] = light[0] * dr.select(alone, 1, len(light))
    return first


def _weight(scattered: dict[str, NDArray[Any]], d: Any) -> Any:
    """What light that comes against rays along ``d`` is to be multiplied with for the leaf that was drawn."""
    return _mueller(scattered, d) if mi.is_polarized else _array(mi.Float, scattered["weight"])


def _of_lamp(light: Any) -> Any:
    """What comes of a lamp's unpolarized light, by the Mueller matrix of its way."""
    return light * mi.mueller.depolarizer(mi.UnpolarizedSpectrum(1)) if mi.is_polarized else light


def _added(light: Any, onto: Any, sum: Any) -> Any:
    """A product added to a sum, of Mueller matrices where light is polarized."""
    return light * onto + sum if mi.is_polarized else dr.fma(light, onto, sum)


def _is_clear(bsdf: Any) -> bool:
    """Whether nearly all of the light that comes to a device goes on along its own line."""
    rng = np.random.default_rng(0)
    box, placed = bsdf.box, bsdf.box.shape()
    points, ends = rng.uniform(-1, 1, (2, 3, TRIALS // 4))
    ends /= np.linalg.norm(ends, axis=0) if box.ball else np.abs(ends).max(axis=0)
    points /= np.maximum(1, np.linalg.norm(points, axis=0)) if box.ball else 1
    start, through = (placed[:3, :3] @ at + placed[:3, 3:] for at in (2 * ends, points))
    scattered = bsdf.scatterer.scatter(start.T, (through - start).T, u=rng.random(TRIALS // 4))
    met = scattered.status != MISSED
    return bool(met.any()) and bool(scattered.transmitted[met].mean() >= CLEAR)


def _rows(vectors: Any) -> NDArray[np.float32]:
    """Vectors as rows."""
    dr.eval(vectors)
    # One by one: for all in one array a kernel would be compiled that knows how many there are.
    return np.stack([np.array(part) for part in (vectors.x, vectors.y, vectors.z)], axis=1)


def _array(kind: Any, values: NDArray[Any]) -> Any:
    """An array of Dr.Jit's of numbers of numpy, which begin where it likes them to: elsewhere, other kernels read them."""
    values = np.asarray(values, bool if kind is mi.Bool else np.float32)
    room = np.empty(values.nbytes + ALIGNED, np.uint8)
    begin = -room.ctypes.data % ALIGNED
    aligned = room[begin : begin + values.nbytes].view(values.dtype)
    aligned[:] = values
    return kind(aligned)


def _columns(kind: Any, rows: NDArray[np.float32]) -> Any:
    """Vectors from their rows."""
    return kind(*(_array(mi.Float, column) for column in rows.T))


def _lanes(mask: Any) -> Any:
    """The numbers of the lanes in which something holds: a single one twice, for arrays of one number have kernels of their own."""
    lanes = dr.compress(mask)
    return dr.repeat(lanes, 2) if dr.width(lanes) == 1 else lanes


def _sampler_at(sampler: Any, places: Any) -> Any:
    """The sampler of some of the paths, which goes on with their numbers."""
    thinner = sampler.clone()
    own = sampler.class_name() == "IndependentSampler"
    if not own:
        # What other samplers keep is their own business; independent numbers do as well from here on.
        thinner = mi.load_dict({"type": "independent"})
        thinner.seed(0, dr.width(places))
        seeds = dr.gather(mi.UInt32, dr.reinterpret_array(mi.UInt32, sampler.next_1d()), places)
    # PCG32: the numbers of a path, and which sequence they are of; all paths may share one.
    parts = [mi.UInt64(0), mi.UInt64(0)]
    state, sequence = dr.detail.update_indices(parts, dr.detail.collect_indices(sampler if own else thinner))
    if own:
        state, sequence = (
            part if dr.width(part) == 1 else dr.gather(mi.UInt64, part, places) for part in (state, sequence)
        )
    else:
        state = state ^ mi.UInt64(seeds)
    dr.eval(state, sequence)
    return dr.detail.update_indices(thinner, dr.detail.collect_indices([state, sequence]))


def _integrator() -> Callable[[Any], Any]:
    class CloakroomPath(mi.SamplingIntegrator):  # type: ignore[misc]
        """Mitsuba's ``path``, and through devices.

        Parameters: ``max_depth`` (-1: endless; crossings of devices do not count), ``rr_depth`` (5), ``hide_emitters``
        (false), ``max_crossings`` (128; light that crosses more is lost), ``see_through`` (true; false blocks all shadow
        rays at devices, which costs less a path and is noisier).
        """

        def __init__(self, props: Any) -> None:
            super().__init__(props)
            max_depth = int(props.get("max_depth", -1))
            if max_depth < -1:
                raise ValueError(f"max_depth is {max_depth}; expected -1, which is endless, or more")
            self.max_depth = max_depth if max_depth >= 0 else 0xFFFFFFFF
            self.rr_depth = int(props.get("rr_depth", 5))
            if self.rr_depth <= 0:
                raise ValueError(f"rr_depth is {self.rr_depth}; it must be above 0")
            self.max_crossings = int(props.get("max_crossings", 128))
            self.see_through = bool(props.get("see_through", True))
            self.hide = bool(props.get("hide_emitters", False))
            self.progress: Callable[[int, int], object] | None = None
            self._room: _Room | None = None

        def to_string(self) -> str:
            return f"CloakroomPath[max_depth = {self.max_depth}, rr_depth = {self.rr_depth}]"

        def aov_names(self) -> list[str]:
            return []

        def _devices(self, scene: Any) -> _Room:
            shapes = _bounding(scene)
            if self._room is None or shapes != self._room.shapes:
                self._room = _Room(scene)
            else:
                self._room.check_bounds()
                self._room.check_all_found(scene)
            return self._room

        def render(
            self,
            scene: Any,
            sensor: Any = 0,
            seed: Any = 0,
            spp: int = 0,
            develop: bool = True,
            evaluate: bool = True,
        ) -> Any:
            from mitsuba.python.ad.integrators.common import ADIntegrator as Common

            if isinstance(sensor, int):
                sensor = scene.sensors()[sensor]
            film = sensor.film()
            size = film.crop_size()
            if film.sample_border():
                size = size + 2 * film.rfilter().border_size()
            pixels = int(dr.prod(size))
            spp = spp or sensor.sampler().sample_count()
            most = PATHS_POLARIZED if mi.is_polarized else PATHS
            fits = [each for each in range(1, spp + 1) if spp % each == 0 and each * pixels <= most]
            at_once = max(fits, default=1)
            passes = spp // at_once
            block = None
            with dr.suspend_grad():
                for number in range(passes):
                    if self.progress is not None:
                        self.progress(number, passes)
                    of_pass = mi.UInt32(seed if number == 0 else int(mi.sample_tea_32(int(seed), number)[0]))
                    # As a number of the program, each seed would compile kernels of its own.
                    dr.make_opaque(of_pass)
                    # A sampler may take more, for its numbers to be those of a whole pattern.
                    sampler, taken = Common.prepare(self, sensor, of_pass, at_once, self.aov_names())
                    ray, weight, pos = Common.sample_rays(self, scene, sensor, sampler)
                    light, valid, _ = self.sample(scene, sampler, ray, None, mi.Bool(True))
                    if block is None:
                        block = film.create_block()
                    self._put(block, film, pos, light * weight, valid, ray.wavelengths, taken)
                    dr.eval(block.tensor())
            film.put_block(block)
            if self.progress is not None:
                self.progress(passes, passes)
            return film.develop() if develop else mi.TensorXf()

        @staticmethod
        def _put(block: Any, film: Any, pos: Any, light: Any, valid: Any, wavelengths: Any, spp: int) -> None:
            from mitsuba.python.ad.integrators.common import ADIntegrator as Common

            alpha = dr.select(valid, mi.Float(1), mi.Float(0))
            special = mi.has_flag(film.flags(), mi.FilmFlags.Special)
            if special or not film.rfilter().is_box_filter():
                Common._splat_to_block(block, film, pos, light, mi.Float(1), alpha, [], wavelengths)
                return
            # The samples of a pixel are added up in their order, so that the sum is the same bytes each time.
            light = mi.unpolarized_spectrum(light)
            if mi.is_spectral:
                color = mi.spectrum_to_srgb(light, wavelengths)
            elif mi.is_monochromatic:
                color = mi.Color3f(light.x)
            else:
                color = light
            first = dr.arange(mi.UInt32, dr.width(pos) // spp) * spp
            values = [color.x, color.y, color.z]
            if mi.has_flag(film.flags(), mi.FilmFlags.Alpha):
                values.append(alpha)
            sums = [dr.block_sum(value + dr.zeros(mi.Float, dr.width(pos)), spp) for value in values]
            block.set_coalesce(False)
            block.put(dr.gather(mi.Vector2f, pos, first), [*sums, mi.Float(spp)])

        def sample(self, scene: Any, sampler: Any, ray: Any, medium: Any = None, active: Any = True) -> Any:
            """The light along rays: a loop on the device that goes on until all paths end or come to a device."""
            room = self._devices(scene)
            width = max(dr.width(ray), sampler.wavefront_size())
            if self.max_depth == 0:
                return dr.zeros(mi.Spectrum, width), dr.zeros(mi.Bool, width), []
            # As with `path`: where there is a sky, no ray goes to nowhere.
            sky = not self.hide and scene.environment() is not None
            state = self._launched(ray, active, width, sky)
            clear = self.see_through and any(room.clear)
            if not room.shapes:
                # Nothing is to be gone on with, so that no more of the state is kept.
                state, _, _ = self._follow(scene, sampler, state, room, False)
                dr.eval(state["result"], state["valid"])
                return dr.select(state["valid"], state["result"], 0), state["valid"], []
            # Leaves are drawn by numbers that the sampler's own are not used up for.
            own = dr.reinterpret_array(mi.UInt32, sampler.clone().next_1d())
            own = own ^ (dr.arange(mi.UInt32, width) * mi.UInt32(0x9E3779B9))
            state["lane"] = dr.arange(mi.UInt32, width)
            state["own"] = own
            result = dr.zeros(mi.Spectrum, width)
            valid = dr.zeros(mi.Bool, width)
            for turn in itertools.count():
                state, shadows, sampler = self._follow(scene, sampler, state, room, clear)
                if shadows is not None:
                    self._shed(scene, room, state, shadows, turn)
                dr.scatter(result, state["result"], state["lane"])
                dr.scatter(valid, state["valid"], state["lane"])
                further = _lanes((state["parked"] != 0) | state["waits"])
                if dr.width(further) == 0:
                    break
                state = {name: dr.gather(type(value), value, further) for name, value in state.items()}
                sampler = _sampler_at(sampler, further)
                dr.eval(state)
                self._cross(room, state)
            return dr.select(valid, result, 0), valid, []

        def _launched(self, ray: Any, active: Any, width: int, sky: bool) -> dict[str, Any]:
            """The state of paths that begin."""
            full = {
                "o": mi.Point3f(ray.o),
                "d": mi.Vector3f(ray.d),
                "maxt": mi.Float(ray.maxt),
                "time": mi.Float(ray.time),
                "wavelengths": ray.wavelengths,
                # Whether only the first wavelength is left, which stands for all.
                "alone": mi.Bool(False),
                "throughput": mi.Spectrum(1),
                "result": mi.Spectrum(0),
                "eta": mi.Float(1),
                "depth": mi.UInt32(0),
                # Where the path was last scattered, and with which density.
                "from": mi.Point3f(0),
                "pdf": mi.Float(1),
                "delta": mi.Bool(True),
                # Whether shadow rays would have found what this ray finds.
                "straight": mi.Bool(True),
                # The device, counted from 1, in whose bounding shape it is, after its rays have been traced.
                "left": mi.UInt32(0),
                "crossings": mi.UInt32(0),
                "valid": mi.Bool(sky),
                "active": mi.Bool(active),
                # The device that it has come to.
                "parked": mi.UInt32(0),
                "waits": mi.Bool(False),
                "slots": mi.UInt32(0),
            }
            spread = {}
            for name, value in full.items():
                if name in ("wavelengths", "alone") and not mi.is_spectral:
                    continue
                spread[name] = value + dr.zeros(type(value), width) if not dr.is_mask_v(value) else value
            return spread

        def _follow(self, scene: Any, sampler: Any, state: dict[str, Any], room: _Room, clear: bool) -> Any:
            """Follows paths until each has ended, has come to a device, or waits for its shadow rays."""
            width = dr.width(state["o"].x)
            shadows: dict[str, Any] | None = None
            if clear:
                shadows = {
                    "o": dr.zeros(mi.Point3f, width * SLOTS),
                    "d": dr.zeros(mi.Vector3f, width * SLOTS),
                    "maxt": dr.zeros(mi.Float, width * SLOTS),
                    "device": dr.zeros(mi.UInt32, width * SLOTS),
                    "light": dr.zeros(mi.Spectrum, width * SLOTS),
                }
                if mi.is_spectral:
                    shadows["alone"] = dr.zeros(mi.Bool, width * SLOTS)
                state["slots"] = dr.zeros(mi.UInt32, width)
            row = dr.arange(mi.UInt32, width) * SLOTS if clear else mi.UInt32(0)
            dr.make_opaque(state)
            names = list(state)
            values = tuple(state[name] for name in names)
            place = {name: number for number, name in enumerate(names)}

            def goes_on(sampler: Any, row: Any, *values: Any) -> Any:
                return values[place["active"]]

            def step(sampler: Any, row: Any, *values: Any) -> Any:
                now = dict(zip(names, values))
                self._step(scene, sampler, now, room, shadows, row)
                return (sampler, row, *(now[name] for name in names))

            sampler.schedule_state()
            sampler, _, *values = dr.while_loop(
                (sampler, row, *values), goes_on, step, labels=["sampler", "row", *names], label="path among devices"
            )
            state = dict(zip(names, values))
            if room.shapes:
                sampler.schedule_state()
                dr.eval(state, shadows)
            return state, shadows, sampler

        def _step(self, scene: Any, sampler: Any, now: dict[str, Any], room: _Room, shadows: Any, row: Any) -> None:
            """One segment of a path: `path.cpp` of Mitsuba, step by step, and what is to do at devices."""
            active = now["active"]
            wavelengths = now.get("wavelengths", [])
            ray = mi.Ray3f(now["o"], now["d"], now["maxt"], now["time"], wavelengths)
            si = scene.ray_intersect(ray, mi.RayFlags.All, now["depth"] == 0, active=active)
            normal = mi.Bool(active)
            through = mi.Bool(False)
            if room.shapes:
                device = room.number(si.shape, active & si.is_valid())
                meets = active & (device != 0)
                # A ray that has been traced through the device, or missed it, goes out of its bounding shape.
                through = meets & (now["left"] == device)
                now["parked"] = dr.select(meets & ~through, device, 0)
                now["left"] = dr.select(through & (dr.dot(si.n, ray.d) > 0), 0, now["left"])
                normal &= ~meets
            if self.hide:
                # Nobody sees lamps themselves, but what is behind.
                hidden = normal & (now["depth"] == 0) & si.is_valid() & (si.emitter(scene) != None)  # noqa: E711
                through |= hidden
                normal &= ~hidden
            before = dr.zeros(mi.Interaction3f)
            before.p, before.time = now["from"], now["time"]
            if mi.is_spectral:
                before.wavelengths = now["wavelengths"]
            # What shines here.
            ds = mi.DirectionSample3f(scene, si, before)
            shines = normal & (si.emitter(scene) != None)  # noqa: E711
            if self.hide:
                shines &= ~(now["depth"] == 0)
            em_pdf = scene.pdf_emitter_direction(before, ds, shines & ~now["delta"])
            mis = dr.select(now["straight"], _mis(now["pdf"], dr.select(now["delta"], 0, em_pdf)), 1)
            emitted = ds.emitter.eval(si, shines & (now["pdf"] > 0))
            now["result"] = dr.select(shines, _added(now["throughput"], emitted * mis, now["result"]), now["result"])
            # Further on?
            further = normal & (now["depth"] + 1 < self.max_depth) & si.is_valid()
            bsdf = si.bsdf()
            samples = further & mi.has_flag(bsdf.flags(), mi.BSDFFlags.Smooth)
            ds, em_weight = scene.sample_emitter_direction(si, sampler.next_2d(normal), False, samples)
            samples &= ds.pdf != 0
            wo = si.to_local(ds.d)
            one, two = sampler.next_1d(normal), sampler.next_2d(normal)
            value, pdf, bs, weight = bsdf.eval_pdf_sample(mi.BSDFContext(), si, wo, one, two, further)
            # From the way that light goes, as Mueller matrices have it.
            value = si.to_world_mueller(value, -wo, si.wi)
            weight = si.to_world_mueller(weight, -bs.wo, si.wi)
            shadow = si.spawn_ray_to(ds.p)
            lit = samples & dr.any(value != 0) if not mi.is_polarized else samples
            if room.shapes:
                found = scene.ray_intersect_preliminary(shadow, False, lit)
                blocked = found.is_valid()
            else:
                blocked = scene.ray_test(shadow, False, lit)
            mis = dr.select(ds.delta, 1, _mis(ds.pdf, pdf))
            if mi.is_polarized:
                # Lamps are unpolarized. What a device does to their light comes before what is done here.
                lamp = mi.Spectrum(0)
                for axis in range(4):
                    lamp[axis, axis] = em_weight[0, 0]
                light = now["throughput"] * value * lamp * mis
            else:
                light = now["throughput"] * value * em_weight * mis
            now["result"] = dr.select(lit & ~blocked, now["result"] + _of_lamp(light), now["result"])
            if shadows is not None:
                screen = room.number(found.shape, lit & blocked)
                queued = lit & blocked & dr.gather(mi.Bool, room.clear_table, screen, lit & blocked)
                slot = row + now["slots"]
                for name, what in (
                    ("o", shadow.o),
                    ("d", shadow.d),
                    ("maxt", shadow.maxt),
                    ("device", screen),
                    ("light", light),
                    ("alone", now.get("alone")),
                ):
                    if what is None:
                        continue
                    dr.scatter(shadows[name], what, slot, queued, mode=dr.ReduceMode.Permute)
                now["slots"] = dr.select(queued, now["slots"] + 1, now["slots"])
            # On along the BSDF.
            along = si.spawn_ray(si.to_world(bs.wo))
            beyond = si.spawn_ray(ray.d)
            scattered = normal & si.is_valid()
            now["o"] = dr.select(scattered, along.o, dr.select(through, beyond.o, now["o"]))
            now["d"] = dr.select(scattered, along.d, now["d"])
            now["maxt"] = dr.select(scattered | through, dr.largest(mi.Float), now["maxt"])
            now["throughput"] = dr.select(normal, now["throughput"] * weight, now["throughput"])
            now["eta"] = dr.select(normal, now["eta"] * bs.eta, now["eta"])
            now["valid"] |= scattered & ~mi.has_flag(bs.sampled_type, mi.BSDFFlags.Null)
            now["from"] = dr.select(normal, si.p, now["from"])
            now["pdf"] = dr.select(normal, bs.pdf, now["pdf"])
            now["delta"] = dr.select(normal, mi.has_flag(bs.sampled_type, mi.BSDFFlags.Delta), now["delta"])
            now["straight"] |= normal
            now["left"] = dr.select(scattered, 0, now["left"])
            # Russian roulette.
            now["depth"] = dr.select(scattered, now["depth"] + 1, now["depth"])
            most = dr.max(mi.unpolarized_spectrum(now["throughput"]))
            keep = dr.minimum(most * dr.square(now["eta"]), 0.95)
            roulette = normal & (now["depth"] >= self.rr_depth)
            lucky = sampler.next_1d(normal) < keep
            now["throughput"] = dr.select(roulette, now["throughput"] * dr.rcp(keep), now["throughput"])
            goes = (further & (~roulette | lucky) & (most != 0)) | through
            if shadows is not None:
                full = goes & (now["slots"] == SLOTS)
                now["waits"] = full
                goes &= ~full
            now["active"] = goes

        def _cross(self, room: _Room, state: dict[str, Any]) -> None:
            """Takes the rays that have come to devices through them."""
            parked = state["parked"]
            state["active"] = mi.Bool(state["waits"])
            for number, scatterers in enumerate(room.scatterers, 1):
                rows = _lanes(parked == number)
                count = dr.width(rows)
                if count == 0:
                    continue
                o, d = dr.gather(mi.Point3f, state["o"], rows), dr.gather(mi.Vector3f, state["d"], rows)
                own, crossings = dr.gather(mi.UInt32, state["own"], rows), dr.gather(mi.UInt32, state["crossings"], rows)
                throughput = dr.gather(mi.Spectrum, state["throughput"], rows)
                disperses = len(scatterers) > 1
                of_first = dr.gather(mi.Float, state["wavelengths"][0], rows) if disperses else None
                scattered = _scatter(scatterers, o, d, mi.sample_tea_float32(own, crossings), of_first)
                status = scattered["status"]
                # Where furniture touches metal, rays may start within it, by rounding: they end.
                goes = (status == MISSED) | (status == LEFT)
                here = _array(mi.Bool, goes) & (crossings < self.max_crossings)
                straight = dr.gather(mi.Bool, state["straight"], rows)
                # Shadow rays end at the bounding shapes of other devices, whether they would meet them or not.
                sees_through = self.see_through and room.clear[number - 1]
                on_line = _array(mi.Bool, scattered["straight"] if sees_through else np.zeros(count, bool))
                if disperses:
                    # Other wavelengths take other ways.
                    met, alone = _array(mi.Bool, status != MISSED), dr.gather(mi.Bool, state["alone"], rows)
                    throughput = dr.select(met, _first_only(throughput, alone), throughput)
                    dr.scatter(state["alone"], alone | met, rows)
                dr.scatter(state["o"], _columns(mi.Point3f, scattered["position"]), rows)
                dr.scatter(state["d"], _columns(mi.Vector3f, scattered["direction"]), rows)
                dr.scatter(state["throughput"], throughput * _weight(scattered, d), rows)
                dr.scatter(state["straight"], straight & on_line, rows)
                dr.scatter(state["left"], mi.UInt32(number) + dr.zeros(mi.UInt32, count), rows)
                dr.scatter(state["maxt"], dr.full(mi.Float, dr.largest(mi.Float), count), rows)
                dr.scatter(state["crossings"], crossings + 1, rows)
                dr.scatter(state["active"], here, rows)
            state["parked"] = dr.zeros(mi.UInt32, dr.width(parked))
            state["waits"] = dr.zeros(mi.Bool, dr.width(parked))

        def _shed(self, scene: Any, room: _Room, state: dict[str, Any], shadows: dict[str, Any], turn: int) -> None:
            """Adds the light that comes to paths through devices along their shadow rays; it is done in turns."""
            width = dr.width(state["slots"])
            slot = dr.arange(mi.UInt32, width * SLOTS)
            used = (slot % SLOTS) < dr.gather(mi.UInt32, state["slots"], slot // SLOTS)
            rows = _lanes(used)
            if dr.width(rows) == 0:
                return
            ways = {name: dr.gather(type(value), value, rows) for name, value in shadows.items()}
            dr.eval(ways)
            light = dr.zeros(mi.Spectrum, width * SLOTS)
            for crossing in range(self.max_crossings):
                # Other numbers than those that draw leaves for paths, and none that a kernel would be compiled for.
                count = dr.opaque(mi.UInt32, (turn * self.max_crossings + crossing) * SLOTS)
                own = dr.gather(mi.UInt32, state["own"], rows // SLOTS) ^ mi.UInt32(0x85EBCA6B)
                draws = mi.sample_tea_float32(own, count + rows % SLOTS)
                for number, scatterers in enumerate(room.scatterers, 1):
                    of_device = _lanes(ways["device"] == number)
                    if dr.width(of_device) == 0:
                        continue
                    o = dr.gather(mi.Point3f, ways["o"], of_device)
                    d = dr.gather(mi.Vector3f, ways["d"], of_device)
                    u = dr.gather(mi.Float, draws, of_device)
                    light_there, of_first = dr.gather(mi.Spectrum, ways["light"], of_device), None
                    if len(scatterers) > 1:
                        lanes = dr.gather(mi.UInt32, rows, of_device) // SLOTS
                        of_first = dr.gather(mi.Float, state["wavelengths"][0], lanes)
                        alone = dr.gather(mi.Bool, ways["alone"], of_device)
                        light_there = _first_only(light_there, alone)
                        dr.scatter(ways["alone"], mi.Bool(True) | alone, of_device)
                    # What of the ray goes on along its line is the mean of what leaves that are drawn say.
                    scattered = _scatter(scatterers, o, d, u, of_first)
                    scattered["weight"] = scattered["transmitted"]
                    dr.scatter(ways["light"], light_there * _weight(scattered, d), of_device)
                arrived = self._on_to_light(scene, room, ways)
                dr.scatter(light, _of_lamp(ways["light"]), rows, arrived)
                left = _lanes(ways["device"] != 0)
                if dr.width(left) == 0:
                    break
                rows = dr.gather(mi.UInt32, rows, left)
                ways = {name: dr.gather(type(value), value, left) for name, value in ways.items()}
                dr.eval(ways)
            for number in range(SLOTS):
                state["result"] = state["result"] + dr.gather(
                    mi.Spectrum, light, dr.arange(mi.UInt32, width) * SLOTS + number
                )

        @staticmethod
        def _on_to_light(scene: Any, room: _Room, ways: dict[str, Any]) -> Any:
            """Takes shadow rays that have been traced through a device on to their lamps or the next device."""
            dr.make_opaque(ways)
            active = dr.any(mi.unpolarized_spectrum(ways["light"]) != 0)
            wavelengths = dr.zeros(type(mi.Ray3f().wavelengths))

            def goes_on(o: Any, maxt: Any, left: Any, next_one: Any, lit: Any, active: Any) -> Any:
                return active

            def step(o: Any, maxt: Any, left: Any, next_one: Any, lit: Any, active: Any) -> Any:
                ray = mi.Ray3f(o, ways["d"], maxt, 0, wavelengths)
                si = scene.ray_intersect(ray, mi.RayFlags.Minimal, False, active=active)
                found = active & si.is_valid()
                device = room.number(si.shape, found)
                through = found & (device == left) & (device != 0)
                lit |= active & ~si.is_valid()
                clear = dr.gather(mi.Bool, room.clear_table, device, found)
                next_one = dr.select(found & ~through & clear, device, next_one)
                beyond = si.spawn_ray(ray.d)
                left = dr.select(through & (dr.dot(si.n, ray.d) > 0), 0, left)
                # It starts a little beyond the shape, and the lamp is so much nearer.
                maxt = dr.select(through, maxt - dr.dot(beyond.o - o, ray.d), maxt)
                o = dr.select(through, beyond.o, o)
                return o, maxt, left, next_one, lit, through & (maxt > 0)

            start = (
                ways["o"],
                ways["maxt"],
                ways["device"],
                dr.zeros(mi.UInt32, dr.width(active)),
                dr.zeros(mi.Bool, dr.width(active)),
                active,
            )
            dr.make_opaque(start)
            o, maxt, _, next_one, lit, _ = dr.while_loop(start, goes_on, step, label="shadow ray among devices")
            ways["o"], ways["maxt"], ways["device"] = o, maxt, next_one
            dr.eval(ways, lit)
            return lit

    return CloakroomPath


def _mis(one: Any, other: Any) -> Any:
    """The power heuristic."""
    one, other = dr.square(one), dr.square(other)
    weight = one / (one + other)
    return dr.detach(dr.select(dr.isfinite(weight), weight, 0))
