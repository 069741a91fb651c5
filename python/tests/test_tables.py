"""Classes made from the catalogue."""

from __future__ import annotations

import copy
import importlib.util
import inspect
import json
import math
import pickle
from pathlib import Path

import numpy as np
import pytest

import cloakroom
from cloakroom import tables


def test_every_device_of_the_catalogue_is_a_class(command) -> None:
    listed = json.loads(command("devices", "--json").stdout)["devices"]
    assert [device["kind"] for device in listed] == list(tables.DEVICES)
    for device in listed:
        cls = tables.DEVICES[device["kind"]]
        assert getattr(cloakroom, cls.__name__) is cls
        parameters = inspect.signature(cls).parameters
        for key in device["keys"]:
            assert parameters[key["name"]].default == key["default"]
            assert f"\n{key['name']} : " in cls.__doc__
        assert {"rotation", "position", "show"} <= set(parameters)


def test_solids_mirrors_and_names() -> None:
    corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]]
    solid = cloakroom.Polyhedron(vertices=corners, name="wedge", material="bk7")
    mirror = cloakroom.Mirror(name="left", position=(9, 0, 0), metal={"material": "silver"})
    ball = cloakroom.Body(shape="sphere", position=(-20, 0, 0), metal=True)
    assert solid.given()["vertices"][1] == [4, 0, 0]
    cloakroom.Scene(devices=[solid, mirror, ball]).check()
    with pytest.raises(ValueError, match="a letter"):
        cloakroom.Mirror(name="2nd")
    with pytest.raises(ValueError, match="too"):
        cloakroom.Scene(devices=[mirror, mirror.replace(position=(30, 0, 0))]).check()


def test_the_stub_is_that_of_the_catalogue() -> None:
    folder = Path(__file__).parents[1]
    spec = importlib.util.spec_from_file_location("stubs", folder / "stubs.py")
    stubs = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(stubs)
    assert (folder / "cloakroom" / "tables.pyi").read_text(encoding="utf-8") == stubs.stub()


def test_what_is_set_does_not_vanish() -> None:
    cloak = cloakroom.SquareCloak(rotation=10)
    scene = cloakroom.Scene(devices=cloak)
    with pytest.raises(AttributeError, match="did you mean `rotation`"):
        cloak.rotaton = 9
    with pytest.raises(AttributeError, match=r"\.replace\(rotation=\.\.\.\)"):
        cloak.rotation = 9
    with pytest.raises(AttributeError, match=r"\.replace\(samples=\.\.\.\)"):
        scene.camera.samples = 9
    with pytest.raises(AttributeError, match=r"\.replace\(\{"):
        scene.samples = 9
    assert cloak == cloakroom.SquareCloak(rotation=10) == scene.devices[0]


@pytest.mark.parametrize(("name", "shape"), [("vertices", (4, 2)), ("vertices", (3, 3)), ("planes", (6, 3)), ("planes", (4,))])
def test_solids_of_wrong_shapes_are_told_at_once(name: str, shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match=rf"{name} has the shape \({shape[0]}"):
        cloakroom.Polyhedron(**{name: np.ones(shape)})


def test_keys_are_given_or_at_their_defaults() -> None:
    cloak = cloakroom.SquareCloak(material="negative-uniaxial", rotation=10, length=None)
    assert repr(cloak) == "SquareCloak(material='negative-uniaxial', rotation=10.0)"
    assert cloak.rotation == 10 and cloak.side == 14.1 and cloak.length is None
    assert math.isclose(cloak.kappa, 1 / math.sqrt(3))
    assert cloak.kind == "square-cloak" and "rotation" in dir(cloak)
    turned = cloak.replace(rotation=20, material=None)
    assert turned == cloakroom.SquareCloak(rotation=20) and turned != cloak
    assert cloak != "a text" and cloakroom.FisheyeLens() != cloakroom.LuneburgLens()
    with pytest.raises(AttributeError, match="colour"):
        cloak.colour


def test_lists_of_tables_do_not_change_either() -> None:
    given = [1.0, 2.0, 3.0]
    cloak = cloakroom.SquareCloak(position=given, imperfection={"error": 0.02})
    given[0] = 99.0
    changes = [
        lambda: cloakroom.SquareCloak().position.__setitem__(1, 15.0),
        lambda: cloakroom.Camera().target.append(1.0),
        lambda: cloak.position.sort(),
        lambda: cloak.imperfection.update(error=0.5),
        lambda: cloakroom.Scene().camera.resolution.__setitem__(0, 40),
    ]
    for change in changes:
        with pytest.raises(TypeError, match="tables do not change"):
            change()
    cloak.given()["position"][0] = 9.0
    assert cloak.position == [1.0, 2.0, 3.0] and cloak.imperfection == {"error": 0.02}
    assert cloakroom.SquareCloak().position == [0.0, 0.0, 0.0] and cloakroom.Scene().camera.resolution == [1024, 768]
    # Copies are lists like any others.
    for own in (copy.deepcopy(cloak.position), copy.copy(cloak.position), list(cloak.position), cloak.position[:]):
        own[0] = 7.0
    assert copy.deepcopy(cloak) == cloak == pickle.loads(pickle.dumps(cloak)) == cloak.replace()
    assert np.array(cloak.position).sum() == 6.0 and repr(cloak.position) == "[1.0, 2.0, 3.0]"


def test_numpy_and_complex_numbers_are_numbers() -> None:
    body = cloakroom.Body(
        shape="sphere", permittivity=2.25 + 0.1j, position=np.array([1.0, 2, 3]), radius=np.float32(2), priority=np.int8(1)
    )
    assert body.permittivity == [2.25, 0.1] and body.position == [1, 2, 3] and body.radius == 2
    tensor = np.diag([1.0, 2.0, 3.0])
    assert cloakroom.Body(permittivity=tensor).permittivity == tensor.tolist()
    prisms = cloakroom.Prisms(prism=[{"corners": np.array([[0, 0], [1, 0], [0, 1]]), "metal": True}])
    assert prisms.prism == [{"corners": [[0, 0], [1, 0], [0, 1]], "metal": True}]


def test_coatings_and_metals_are_tables_within_a_device() -> None:
    silver = {"index": 0.06 + 3.6j, "thickness_nm": 25}
    body = cloakroom.Body(shape="slab", permittivity=2.25, coating=[silver])
    assert body.coating == [{"index": [0.06, 3.6], "thickness_nm": 25}]
    carpet = cloakroom.GaussianCarpet(metal={"index": 0.27 + 2.9j})
    assert carpet.metal == {"index": [0.27, 2.9]} and cloakroom.SquareCloak().metal is None
    assert "``thickness_nm``" in str(cloakroom.Body.__doc__) and "``index``" in str(cloakroom.GaussianCarpet.__doc__)
    # What a film of 25 nm on either side of the slab and the metal keep is absorbed.
    for device in (body, carpet.replace(rotation=90)):
        traced = cloakroom.trace(cloakroom.Scene(devices=device), [-50, 1, 0], [1, 0, 0])
        assert traced.absorbed[0] > 0.01
    with pytest.raises(ValueError, match="thickness_nm is -1 nm"):
        cloakroom.Body(coating=[{"index": 1.4, "thickness_nm": -1}])


@pytest.mark.parametrize(
    ("kind", "keys", "error", "message"),
    [
        ("SquareCloak", {"sidee": 1}, TypeError, "unknown key `sidee` in a square-cloak; did you mean `side`?"),
        ("SquareCloak", {"side": -3}, ValueError, "side is -3 cm; it must be from 1e-6 to 1000000"),
        ("SquareCloak", {"side": math.nan}, ValueError, "side is not a number (nan); numbers must be finite"),
        ("SquareCloak", {"side": "wide"}, ValueError, 'side is "wide"; it must be a number (cm)'),
        ("SquareCloak", {"material": "glas"}, ValueError, "material is"),
        ("SquareCloak", {"side": object()}, TypeError, "side is a object; it must be"),
        ("SquareCloak", {"position": [1, 2]}, ValueError, "position is [1, 2]; it must be three numbers (cm)"),
        ("SquareCloak", {"position": np.zeros((2000, 2000))}, ValueError, "4000000 entries"),
        ("Body", {"priority": 2**80}, ValueError, "priority: whole numbers must fit into 64 bits"),
        ("Body", {"surface": {1: 2}}, TypeError, "a key that is not a text"),
        ("Camera", {"resolution": [0, 10]}, ValueError, "the first number of resolution is 0"),
        ("Camera", {"samples": 1.5}, ValueError, "samples is 1.5; it must be a whole number"),
        ("Photograph", {"image": np.zeros((2, 3, 5))}, ValueError, "image has the shape (2, 3, 5)"),
        ("Photograph", {"image": np.zeros((0, 3, 3))}, ValueError, "image has the shape (0, 3, 3)"),
        ("Photograph", {"image": np.zeros((2, 3), dtype=int)}, TypeError, "image is of the type int64"),
        ("Photograph", {"image": np.full((2, 3), np.inf)}, ValueError, "not a finite number, in column 0 and row 0"),
        ("Photograph", {"image": b"x.png"}, TypeError, "image is a bytes"),
        ("Graded", {"index": np.ones((2, 9))}, ValueError, "index has the shape (2, 9); expected 4 samples at least"),
        ("Graded", {"index": np.ones((9, 9)), "ratio": np.ones((5, 5))}, ValueError, "ratio has the shape (5, 5); expected (9, 9)"),
        ("Graded", {"index": np.ones((9, 9)), "optic_axis": np.ones((9, 2))}, ValueError, "expected (3,) or (9, 9) or (9, 9, 3)"),
        ("Device", {}, TypeError, "take one of its subclasses"),
    ],
)
def test_bad_keys_are_told(kind: str, keys: dict, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as raised:
        getattr(cloakroom, kind)(**keys)
    assert message in str(raised.value)


def test_lists_in_themselves_end() -> None:
    endless: list = []
    endless.append(endless)
    with pytest.raises(TypeError, match="without end"):
        cloakroom.SquareCloak(position=endless)


def test_tables_can_be_sent_to_other_processes() -> None:
    cloak = cloakroom.SquareCloak(rotation=3)
    assert pickle.loads(pickle.dumps(cloak)) == cloak
    photograph = cloakroom.Photograph(image=np.full((2, 3, 3), 7, dtype=np.uint8), x=60)
    copy = pickle.loads(pickle.dumps(photograph))
    assert copy.x == 60 and copy.image == photograph.image == "array:3x2"
