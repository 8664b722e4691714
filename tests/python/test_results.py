"""Results of runs that are read from their folders: names, units, fields of all frames, and what is told when a file is
missing or broken.

    SMALL_FORMS=build/strict/small_forms python3 -m unittest discover -s tests/python -p test_results.py
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from functools import cached_property
from pathlib import Path
from unittest import mock

import h5py
import numpy as np
import xarray

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parents[1] / "python"
sys.path[:0] = [str(HERE), str(PACKAGE)]

import pyroclast  # noqa: E402
import small_forms  # noqa: E402
from pyroclast.errors import Error  # noqa: E402
from pyroclast.stored import fields  # noqa: E402
from pyroclast.stored.results import GrowingResults, Results  # noqa: E402

FORM, WALL = "starter", "thermal_wall"
FRAMES = small_forms.FRAMES


class Case(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        self.folder = small_forms.copy(FORM, self.root / "run")
        self.results = pyroclast.read(self.folder)

    @cached_property
    def blocks(self) -> dict[str, np.ndarray]:
        """Arrays of the blocks' mesh, as the file has them."""
        with h5py.File(self.folder / "fields" / "mesh.h5") as file:
            arrays = {name: values[()] for name, values in file["blocks"].items()}
        return arrays | {"zones": arrays["Connectivity"].reshape(-1, 3), "points": arrays["Points"][:, :2]}

    def area(self) -> np.ndarray:
        """Areas of the zones, m2."""
        a, b, c = (self.blocks["points"][corners] for corners in self.blocks["zones"].T)
        return 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])

    def mean_of_blocks(self, values: np.ndarray) -> np.ndarray:
        """Means over the zones (Z, ...) of each block by area."""
        block, area = self.blocks["block"], self.area()
        return np.array([np.average(values[block == b], axis=0, weights=area[block == b])
                         for b in range(block.max() + 1)])

    def count_reads(self):
        """Counts the arrays that are read from files of frames."""
        counted = mock.patch.object(fields, "read_array", wraps=fields.read_array)
        self.addCleanup(counted.stop)
        return counted.start()

    def refused(self, call, *texts: str) -> None:
        with self.assertRaises(Error) as caught:
            call()
        for text in texts:
            self.assertIn(text, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))


class Reading(Case):
    def test_a_folder_of_a_run_gives_its_results(self):
        self.assertIsInstance(self.results, pyroclast.Results)
        summary = json.loads((self.folder / "summary.json").read_text())
        self.assertEqual((self.results.title, self.results.outcome), (summary["title"], summary["outcome"]))
        self.assertEqual(self.results.results["f_c_MPa"], summary["stages"][1]["results"]["f_c_MPa"])
        self.assertEqual([stage["kind"] for stage in self.results.stages], ["settle", "compress"])
        self.assertEqual(self.results.warnings, summary["warnings"])

    def test_where_two_stages_have_a_result_the_later_one_counts(self):
        with small_forms.facts(self.folder / "summary.json") as summary:
            summary["stages"][0]["results"], summary["stages"][1]["results"] = {"E_GPa": 30.0, "a": 1}, {"E_GPa": 9.0}
        self.assertEqual(pyroclast.read(self.folder).results, {"E_GPa": 9.0, "a": 1})

    def test_another_folder_is_told_for_what_it_is(self):
        specimen = small_forms.copy_specimen(FORM, self.root / "specimen")
        self.refused(lambda: pyroclast.read(specimen), str(specimen), "holds a specimen", "SpecimenFolder")
        self.assertEqual(pyroclast.SpecimenFolder(specimen).shares, pyroclast.SpecimenFolder(self.folder).shares)
        (self.root / "several").mkdir()
        for name in ("a", "b", "c"):
            shutil.copytree(self.folder, self.root / "several" / name)
        self.refused(lambda: pyroclast.read(self.root / "several"), "folders of runs: a and 2 more")
        (self.root / "empty").mkdir()
        self.refused(lambda: pyroclast.read(self.root / "empty"), "holds no run")
        self.refused(lambda: pyroclast.read(self.root / "nowhere"), "is not a folder")

    def test_a_run_that_is_not_over_tells_so(self):
        (self.folder / "summary.json").unlink()
        self.assertEqual((self.results.outcome, self.results.results, self.results.stages), ("broken off", {}, []))
        (self.folder / "lock").write_text("1\n")  # that nobody holds
        self.assertEqual(self.results.outcome, "killed")


class HistoryOfResults(Case):
    def header(self) -> list[str]:
        return (self.folder / "history.csv").read_text().split("\n", 1)[0].split(",")

    def test_names_without_units_are_in_si(self):
        history = self.results.history
        np.testing.assert_array_equal(history["stress"], 1e6 * history["stress_MPa"])
        np.testing.assert_array_equal(history["time"], history["time_s"])
        self.assertEqual((history.units["stress_MPa"], history.units["strain"]), ("MPa", "1"))
        self.assertEqual(list(history), self.header())
        self.assertEqual(len(history["strain"]), history.rows)

    def test_pandas_keeps_the_units(self):
        for table in (self.results.to_pandas(), self.results.history.to_pandas()):
            self.assertEqual(list(table), self.header())
            self.assertEqual(table.attrs["units"], self.results.history.units)
            np.testing.assert_array_equal(table["stress_MPa"], self.results.history["stress_MPa"])

    def test_a_column_is_not_to_be_changed_and_one_that_is_not_there_is_named_with_the_file(self):
        with self.assertRaisesRegex(ValueError, "read-only"):
            self.results.history["strain"][0] = 1.0
        self.refused(lambda: self.results.history["colour"], "history.csv", "'colour'")

    def test_a_record_that_is_called_strain_makes_no_test_between_platens(self):
        folder = small_forms.copy("notched_beam", self.root / "beam", fields=False)
        for name in ("history.csv", "run.json"):
            (folder / name).write_text((folder / name).read_text().replace("cmod_m", "strain_m"))
        self.assertFalse(pyroclast.read(folder).has_platens)
        self.assertTrue(pyroclast.read(folder).moves)


class Facts(Case):
    def test_roles_find_columns_and_modes(self):
        facts = self.results.facts
        self.assertEqual(facts.press("stress"), "stress_MPa")
        self.assertEqual([column.of for column in facts.of_role("energy.held")],
                         ["elastic_zones", "elastic_contacts", "kinetic"])
        self.assertEqual(facts.crack_modes, {mode: ["aggregate_mortar", "mortar_mortar"] for mode in ("tension", "shear")})
        self.assertEqual(facts.text_about("f_c_MPa", "reason"), "f_c_none_because")
        self.assertIsNone(facts.column("probe"))
        with self.assertRaisesRegex(Error, "run.json: no column is the slip between platens"):
            facts.press("slip")

    def test_what_is_missing_or_of_another_kind_is_an_error_with_the_file(self):
        path = self.folder / "run.json"
        whole = json.loads(path.read_text())
        for name, value in (("moves", 1), ("dimension", True), ("extent", {"name": "length"}), ("columns", {}),
                            ("columns", [5]), ("columns", [{"name": "stage"}]), ("test_stage", "1"),
                            ("results", [whole["results"][0] | {"digits": "1"}])):
            path.write_text(json.dumps(whole | {name: value}))
            facts = pyroclast.Results(self.folder).facts
            with self.subTest(name, value=value), self.assertRaisesRegex(Error, f"run.json: '{name}'"):
                getattr(facts, name)
        path.unlink()
        with self.assertRaisesRegex(Error, "run.json: is missing: .*run its deck.toml again"):
            self.results.facts  # noqa: B018


class FieldsOfFrames(Case):
    def test_they_have_the_names_of_the_files_and_units_beside_them(self):
        found = self.results.fields
        with h5py.File(self.folder / "fields" / "contacts_0000.hdf") as file:
            in_file = dict(name.removesuffix("]").split(" [") for name in file["VTKHDF/CellData"] if name.endswith("]"))
        del in_file["length"]  # of the mesh
        units = {name: found[name].attrs["units"] for name in found}
        self.assertEqual({name: units.get(name) for name in in_file}, in_file)
        self.assertEqual((units["displacement"], units["contact_displacement"], units["stress"]), ("m", "m", "Pa"))
        for name, dims in (("displacement", ("frame", "gridpoint", "component")),
                           ("stress", ("frame", "zone", "tensor")),
                           ("contact_displacement", ("frame", "contact", "end", "component")),
                           ("tension_damage", ("frame", "contact"))):
            self.assertEqual(found[name].dims, dims)
        self.assertEqual(found["component"].values.tolist(), ["x", "y"])
        self.assertEqual(found["tensor"].values.tolist(), ["xx", "yy", "zz", "xy", "yz", "xz"])

    def test_coordinates_tell_state_place_and_material(self):
        found = self.results.fields
        frames = self.results.frames
        self.assertEqual(found.sizes["frame"], FRAMES)
        np.testing.assert_array_equal(found["stage"], [frame.stage for frame in frames])
        np.testing.assert_array_equal(found["test_strain"], [frame.strain for frame in frames])
        np.testing.assert_array_equal(found["test_stress"], [1e6 * frame.stress for frame in frames])
        self.assertEqual((found["test_stress"].attrs["units"], found["time"].attrs["units"]), ("Pa", "s"))
        np.testing.assert_array_equal(found["position"], self.blocks["points"])
        np.testing.assert_array_equal(found["block"], self.blocks["block"])
        names = self.blocks["material_names"].astype(str)
        np.testing.assert_array_equal(found["material"], names[self.blocks["material"]])
        np.testing.assert_array_equal(found["bearing"], self.blocks["bearing"] == 1)
        contacts = self.results.mesh.contacts
        np.testing.assert_array_equal(found["interface"], np.array(contacts.interfaces)[contacts.interface])
        np.testing.assert_allclose(found["area"], self.area(), rtol=1e-9)

    def test_values_are_those_of_the_files(self):
        found = self.results.fields
        for frame in self.results.frames[::5]:
            np.testing.assert_array_equal(found["displacement"].isel(frame=frame.number),
                                          self.results.gridpoint_displacement(frame))
            np.testing.assert_array_equal(found["tension_damage"].isel(frame=frame.number),
                                          self.results.contact_field(frame, "tension_damage [1]"))
            of_ends = self.results.contact_displacement(frame).reshape(-1, 2, 2)
            np.testing.assert_array_equal(found["contact_displacement"].isel(frame=frame.number), of_ends)

    def test_only_the_frames_that_are_asked_for_are_read(self):
        reads = self.count_reads()
        found = self.results.fields
        self.assertEqual(reads.call_count, 0)
        one = found["displacement"].isel(frame=5)
        self.assertEqual(reads.call_count, 0)
        one.load()
        self.assertEqual([call.args[0].name for call in reads.call_args_list], ["blocks_0005.hdf"])
        found["shear_damage"].sel(frame=[2, 7]).load()
        self.assertEqual([call.args[0].name for call in reads.call_args_list[1:]],
                         ["contacts_0002.hdf", "contacts_0007.hdf"])
        self.assertEqual(found.nbytes, found.copy().load().nbytes)  # known before it is read

    def test_any_part_is_what_it_is_of_the_whole(self):
        lazy, whole = self.results.fields["displacement"], self.results.fields["displacement"].copy().load()
        points = xarray.DataArray([0, 3, 5], dims="line")
        for part in ({"frame": -1}, {"frame": slice(None, None, -3)}, {"frame": [4, 1, 1]}, {"gridpoint": 3},
                     {"frame": 2, "gridpoint": [5, 2], "component": 1}, {"frame": slice(3, 3)},
                     {"frame": [0, 3], "gridpoint": slice(10, 0, -2), "component": [1]},
                     {"frame": points, "gridpoint": 2 * points}):
            with self.subTest(part):
                taken, wanted = lazy.isel(part), whole.isel(part)
                self.assertEqual(taken.dims, wanted.dims)
                np.testing.assert_array_equal(taken.values, wanted.values)

    def test_blocks_have_the_mean_of_their_zones_by_area(self):
        means = self.results.block_fields
        self.assertEqual(means["displacement"].dims, ("frame", "block", "component"))
        self.assertEqual(means["displacement"].attrs["units"], "m")
        self.assertEqual(means["material"].values[-1], "platen")
        with h5py.File(self.folder / "fields" / "blocks_0003.hdf") as file:
            stress = file["VTKHDF/CellData/stress [Pa]"][()]
        np.testing.assert_allclose(means["stress"].isel(frame=3), self.mean_of_blocks(stress), rtol=1e-5, atol=1.0)
        of_corners = self.results.gridpoint_displacement(self.results.frames[3])[self.blocks["zones"]]
        np.testing.assert_allclose(means["displacement"].isel(frame=3), self.mean_of_blocks(of_corners.mean(axis=1)),
                                   rtol=1e-5, atol=1e-15)
        centres = self.blocks["points"][self.blocks["zones"]].mean(axis=1)
        np.testing.assert_allclose(means["position"], self.mean_of_blocks(centres), atol=1e-12)

    def test_a_field_that_only_later_stages_have_is_nan_before(self):
        values = np.arange(len(self.results.mesh.contacts.interface), dtype=np.float32)
        for number in (FRAMES - 2, FRAMES - 1):
            with h5py.File(self.folder / "fields" / f"contacts_{number:04d}.hdf", "a") as file:
                file["VTKHDF/CellData/heat_conductance [W m-2 K-1]"] = values
        conductance = self.results.fields["heat_conductance"]
        self.assertEqual(conductance.attrs["units"], "W m-2 K-1")
        self.assertTrue(np.isnan(conductance.isel(frame=slice(0, -2))).all())
        np.testing.assert_array_equal(conductance.isel(frame=-2), values)

    def test_heat_alone_has_temperatures(self):
        results = pyroclast.read(small_forms.copy(WALL, self.root / "wall"))
        self.assertEqual(set(results.fields), {"temperature"})
        self.assertEqual(results.fields["mean_temperature"].values.tolist(),
                         [frame.temperature for frame in results.frames])
        self.assertLessEqual({"heating_time", "position"}, set(results.fields.coords))
        self.assertFalse({"test_strain", "interface", "step"} & set(results.fields.coords))

    def test_a_heated_run_has_its_temperatures_beside_its_stress(self):
        found = pyroclast.read(small_forms.copy("fire_one_side", self.root / "hot")).fields
        self.assertEqual(found["temperature"].dims, ("frame", "gridpoint"))
        self.assertIn("stress", found)
        self.assertEqual(found["mean_temperature"].attrs["units"], "degC")

    def test_a_run_that_grows_has_the_frames_by_now(self):
        table = self.folder / "fields" / "frames.csv"
        lines = table.read_text().splitlines(keepends=True)
        table.write_text("".join(lines[:4]))
        growing = GrowingResults(self.folder)
        self.assertEqual(growing.fields.sizes["frame"], 3)
        table.write_text("".join(lines))
        growing.refresh()
        self.assertEqual(growing.fields.sizes["frame"], FRAMES)


class WhatIsMissingOrBrokenIsNamed(Case):
    def broken(self, name: str, call, *texts: str) -> None:
        """What is told of a file that is missing, and of one that is cut off."""
        path = self.folder / name
        content = path.read_bytes()
        path.unlink()
        with self.subTest(missing=name):
            self.refused(lambda: call(Results(self.folder)), str(path), *texts)
        path.write_bytes(content[:len(content) // 3])
        with self.subTest(cut=name):
            self.refused(lambda: call(Results(self.folder)), str(path))
        path.write_bytes(content)

    def test_each_file(self):
        self.broken("fields/blocks_0003.hdf", lambda results: results.fields["stress"].isel(frame=3).load())
        self.broken("fields/contacts_0000.hdf", lambda results: results.fields)
        self.broken("fields/mesh.h5", lambda results: results.block_fields)
        (self.folder / "history.csv").write_text("stage,strain\n0,x\n")
        self.refused(lambda: Results(self.folder).history, "history.csv, line 2", "'x'")
        (self.folder / "history.csv").unlink()
        self.refused(lambda: pyroclast.read(self.folder).to_pandas(), "history.csv")

    def test_other_frames_are_read_beside_one_that_is_missing(self):
        (self.folder / "fields" / "blocks_0003.hdf").unlink()
        self.assertEqual(self.results.fields["stress"].isel(frame=[2, 4]).load().sizes["frame"], 2)

    def test_an_array_that_lies_in_another_file(self):
        path, name = self.folder / "fields" / "blocks_0003.hdf", "VTKHDF/CellData/stress [Pa]"
        (self.folder / "secret").write_bytes(b"secret" * 10000)
        content = path.read_bytes()
        with h5py.File(path) as file:
            shape = file[name].shape
        layout = h5py.VirtualLayout(shape, "f4")
        layout[:] = h5py.VirtualSource("secret.h5", "a", shape)
        for damage in (
                lambda file: file.create_dataset(name, shape, "u1", external=[(str(self.folder / "secret"), 0, 60000)]),
                lambda file: file.create_virtual_dataset(name, layout),
                lambda file: file.__setitem__(name, h5py.ExternalLink("secret.h5", "/a")),
                lambda file: file.__setitem__(name, h5py.ExternalLink("mesh.h5", "/blocks/Points")),
                lambda file: file.__setitem__(name, h5py.SoftLink("/VTKHDF/CellData/material"))):
            with h5py.File(path, "a") as file:
                del file[name]
                damage(file)
            self.refused(lambda: Results(self.folder).fields["stress"].load(), str(path), "stress [Pa]",
                         "data of a run lie in its folder")
            path.write_bytes(content)
        Results(self.folder).fields["stress"].load()

    def test_an_array_that_is_missing_or_does_not_fit_the_mesh(self):
        for number, values in ((2, None), (3, np.zeros((3, 6))), (0, np.zeros((3, 6))), (FRAMES - 1, np.zeros(7))):
            path = self.folder / "fields" / f"blocks_{number:04d}.hdf"
            content = path.read_bytes()
            with h5py.File(path, "a") as file:
                del file["VTKHDF/CellData/stress [Pa]"]
                if values is not None:
                    file["VTKHDF/CellData/stress [Pa]"] = values
            with self.subTest(frame=number):
                self.refused(lambda: Results(self.folder).fields["stress"].load(), str(path), "stress [Pa]")
            path.write_bytes(content)

    def test_a_run_without_frames(self):
        for file in (self.folder / "fields").iterdir():
            if file.name != "mesh.h5":
                file.unlink()
        self.refused(lambda: self.results.fields, str(self.folder), "no frame")

    def test_a_summary_that_is_none(self):
        (self.folder / "summary.json").write_text("[]")
        self.refused(lambda: Results(self.folder).results, "summary.json")
        (self.folder / "summary.json").write_text(json.dumps({"stages": [3]}))
        self.refused(lambda: Results(self.folder).results, "summary.json", "'stages'")
        (self.folder / "summary.json").write_text(json.dumps({"stages": [], "warnings": [1]}))
        self.refused(lambda: Results(self.folder).warnings, "summary.json", "'warnings'")

    def test_a_library_that_is_not_there_is_named_with_its_package(self):
        code = ("import sys; sys.modules['xarray'] = sys.modules['pandas'] = None\n"
                f"sys.path.insert(0, {str(PACKAGE)!r})\nimport pyroclast\n"
                f"results = pyroclast.read({str(self.folder)!r})\n"
                "for ask in (lambda: results.fields, lambda: results.block_fields, lambda: results.to_pandas()):\n"
                "    try: ask()\n"
                "    except pyroclast.Error as error: print(error)\n")
        told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        self.assertEqual(told.splitlines(), [f"{what} needs {name}: install the Debian package python3-{name}"
                                             for what, name in (("Results.fields", "xarray"),
                                                                ("Results.block_fields", "xarray"),
                                                                ("to_pandas", "pandas"))])


class InANotebook(Case):
    def test_title_outcome_curve_and_results_of_the_stages_are_shown(self):
        shown = self.results._repr_html_()
        self.assertIn(f'<img alt="{self.results.title}: {self.results.outcome}" src="data:image/png;base64,', shown)
        self.assertIn("stage 1 (compress): the stress fell", shown)
        self.assertIn("<td>f_c_MPa</td><td>24.79</td>", shown)
        self.assertTrue(self.results._repr_png_().startswith(b"\x89PNG"))
        self.assertEqual(repr(self.results), f"<Results of {self.folder}>")

    def test_titles_are_texts(self):
        (self.folder / "summary.json").write_text('{"title": "<b>&", "outcome": "completed", "stages": []}')
        self.assertIn('alt="&lt;b&gt;&amp;: completed"', Results(self.folder)._repr_html_())

    def test_heat_alone_and_a_run_without_fields_are_shown(self):
        small_forms.copy(WALL, self.root / "wall")
        shutil.rmtree(self.folder / "fields")
        for folder in (self.root / "wall", self.folder):
            self.assertIn("data:image/png", pyroclast.read(folder)._repr_html_())

    def test_what_cannot_be_read_is_told_in_its_place(self):
        (self.folder / "history.csv").unlink()
        shown = Results(self.folder)._repr_html_()
        self.assertIn("history.csv: cannot be read", shown)
        self.assertIn("<td>f_c_MPa</td><td>24.79</td>", shown)
        (self.folder / "summary.json").write_text("[]")
        self.assertIn("summary.json", Results(self.folder)._repr_html_())
        small_forms.copy(WALL, self.root / "wall")
        (self.root / "wall" / "deck.toml").write_text("=")
        self.assertIn("deck.toml: cannot be read", pyroclast.read(self.root / "wall")._repr_html_())


if __name__ == "__main__":
    unittest.main()
